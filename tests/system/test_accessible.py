"""axe finds nothing on any part of the page, however it is looked at, well and in trouble."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import yaml

from arboleda.dashboard.wording import LANGUAGES

from .conftest import SHIPPED
from .page import PARTS, PATIENCE_MS, connected, running, show

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright", "axe_playwright_python")]

SCREENS = {
    "phone": {"viewport": {"width": 390, "height": 844}, "has_touch": True},
    "desktop": {"viewport": {"width": 1280, "height": 800}},
}
Look = Callable[[str], Any]


@pytest.fixture(params=itertools.product(LANGUAGES, ("light", "dark"), SCREENS), ids="-".join)
def look(request: pytest.FixtureRequest, browser: Any) -> Iterator[Look]:
    """`look(address)`: a page as one of those who look at it has it."""
    language, scheme, screen = request.param
    context = browser.new_context(locale=language, color_scheme=scheme, **SCREENS[screen])

    def go(address: str) -> Any:
        page = context.new_page()
        page.set_default_timeout(PATIENCE_MS)
        page.goto(address)
        connected(page)
        assert page.get_attribute("html", "lang") == language
        return page

    yield go
    context.close()


def found(page: Any, where: str) -> list[str]:
    """What axe finds, a line each."""
    from axe_playwright_python.base import AXE_SCRIPT

    page.evaluate("script => window.axe ?? eval(script)", AXE_SCRIPT)
    rules = page.evaluate("axe.run(document, {resultTypes: ['violations']})")["violations"]
    return [f"{where}: {rule['id']}: {node['html']}" for rule in rules for node in rule["nodes"]]


@pytest.fixture(scope="module")
def at_work(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A plant where a task was done, one failed, and nothing runs."""
    folder = tmp_path_factory.mktemp("at-work")
    plant = yaml.safe_load(SHIPPED.read_text())
    plant["cells"]["sis_c"]["drive_to_start"] = False
    file = folder / "plant.yaml"
    file.write_text(yaml.safe_dump(plant))
    with running(folder, "--plant", str(file), "sis_a 0B 7 #done", "sis_c 2A 5 #failed") as address:
        yield address


@pytest.fixture(scope="module")
def in_trouble(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A plant with shared zones whose boards never come."""
    folder = tmp_path_factory.mktemp("in-trouble")
    shared = str(SHIPPED.with_name("shared.yaml"))
    with running(folder, "--plant", shared, "--boards", "real", "--rate", "1") as address:
        yield address


def test_axe_finds_nothing_on_a_plant_at_work(at_work: str, look: Look) -> None:
    page = look(at_work)
    page.wait_for_selector('[data-row=done][data-s="done"]', state="attached")
    page.wait_for_selector('[data-row=failed][data-s="failed"]', state="attached")
    violations = []
    for part in PARTS:
        show(page, part)
        violations += found(page, part)
    show(page, "tasks")
    page.click("[data-row=failed] a")
    page.wait_for_selector("#task g.node.is-failure")
    violations += found(page, "a task that failed")
    page.click("#task g.node.is-failure[data-path='0']")
    page.wait_for_selector("#node:visible")
    violations += found(page, "a node of its tree")
    page.click("#node-close")
    show(page, "cells")
    page.click("[data-choose=sis_b]")
    violations += found(page, "a cell that nobody gave a task")
    show(page, "panel")
    page.click("[data-scope=sis_a]")
    violations += found(page, "the verbs of a cell")
    page.click(".verb[data-verb=home] button")
    page.wait_for_selector("dialog button:focus")
    violations += found(page, "a question")
    assert not violations, "\n".join(violations)


def test_axe_finds_nothing_on_a_plant_in_trouble(in_trouble: str, look: Look) -> None:
    page = look(in_trouble)
    page.click("#stop")
    page.wait_for_selector(".stop-state[data-s=unconfirmed]")
    violations = []
    for part in PARTS:
        show(page, part)
        violations += found(page, part)
    page.click("[data-tab=panel]")
    page.click("[data-scope=left]")
    violations += found(page, "the verbs of a cell")
    page.evaluate("window.socket.disconnect()")
    page.wait_for_selector(".silent #connection:not([hidden])")
    violations += found(page, "no news")
    assert not violations, "\n".join(violations)
