"""axe finds nothing on any part of the page, however it is looked at, well and in trouble."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
import yaml

from arboleda.cli.client import PlantClient
from arboleda.dashboard.wording import LANGUAGES
from arboleda.model.messages import Verb

from ..chromium import leave
from ..lengths import sample
from ..patience import PATIENCE_MS
from .conftest import SHIPPED
from .page import PARTS, connected, ended, operate, running, show

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright", "axe_playwright_python")]

SCREENS = {
    "phone": {"viewport": {"width": 390, "height": 844}, "has_touch": True},
    "desktop": {"viewport": {"width": 1280, "height": 800}},
}
# each language on one screen, each screen in one language: words and widths show on their own
VIEWS = [*zip(LANGUAGES, SCREENS, strict=True)]
JUDGE = """async (options) => {
  await new Promise((drawn) => requestAnimationFrame(() => setTimeout(drawn)));
  const { violations } = await axe.run(document, { preload: false, resultTypes: ["violations"], ...options });
  return violations.flatMap(({ id, nodes }) => nodes.map(({ html }) => `${id}: ${html}`));
}"""
ALL: dict[str, Any] = {}
OF_COLOURS = {
    "runOnly": ["color-contrast", "link-in-text-block"]
}  # the dark changes nothing else: test_looks.py


# what changes its colours by a script has done so then
TWO_FRAMES = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


class Eye:
    """Looks at a page in light and in the dark; what axe finds there is a line each of `violations`."""

    def __init__(self, page: Any) -> None:
        from axe_playwright_python.base import AXE_SCRIPT

        self.page = page
        self.violations: list[str] = []
        page.evaluate(f"() => {{ {AXE_SCRIPT} }}")

    def look(self, where: str) -> None:
        self._judge(where, ALL)
        self.page.emulate_media(color_scheme="dark")
        self.page.evaluate(TWO_FRAMES)
        self._judge(f"{where} in the dark", OF_COLOURS)
        self.page.emulate_media(color_scheme="light")

    def _judge(self, where: str, options: dict[str, Any]) -> None:
        self.violations += [f"{where}: {line}" for line in self.page.evaluate(JUDGE, options)]


def views_from(first: int) -> pytest.MarkDecorator:
    """Have `eye` look in every view, and in the one of this number alone where tests sample."""
    found = sample(VIEWS[first:] + VIEWS[:first], every=len(VIEWS))
    return pytest.mark.parametrize("eye", found, ids="-".join, indirect=True)


@pytest.fixture
def eye(request: pytest.FixtureRequest, browser: Any) -> Iterator[Callable[[str], Eye]]:
    """`eye(address)` is on the page as one of those who look at it has it."""
    language, screen = request.param
    context = browser.new_context(locale=language, color_scheme="light", **SCREENS[screen])

    def go(address: str) -> Eye:
        page = context.new_page()
        page.set_default_timeout(PATIENCE_MS)
        page.goto(address)
        connected(page)
        assert page.get_attribute("html", "lang") == language
        return Eye(page)

    yield go
    leave(context)


@pytest.fixture(scope="module")
def at_work(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A plant where a task was done, one failed, and nothing runs."""
    folder = tmp_path_factory.mktemp("at-work")
    plant = yaml.safe_load(SHIPPED.read_text())
    plant["cells"]["sis_c"]["drive_to_start"] = False
    file = folder / "plant.yaml"
    file.write_text(yaml.safe_dump(plant))
    with running(folder, "--plant", str(file), "sis_a 0B 7 #done", "sis_c 2A 5 #failed") as address:
        ended(address, "done", "failed")
        yield address


@pytest.fixture(scope="module")
def in_trouble(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A plant with shared zones whose boards never come."""
    folder = tmp_path_factory.mktemp("in-trouble")
    shared = str(SHIPPED.with_name("shared.yaml"))
    with running(folder, "--plant", shared, "--boards", "real", "--rate", "1") as address:
        yield address


@pytest.fixture(scope="module")
def crowd(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A plant of seven cells, of which the last is stopped."""
    folder = tmp_path_factory.mktemp("crowd")
    plant = yaml.safe_load(SHIPPED.read_text())
    plant["cells"] = {f"c{n}": numbered(plant["cells"]["sis_a"], n) for n in range(1, 8)}
    file = folder / "plant.yaml"
    file.write_text(yaml.safe_dump(plant))
    with running(folder, "--plant", str(file)) as address:
        PlantClient(folder).operate(Verb.STOP, "c7")
        yield address


def numbered(cell: dict[str, Any], n: int) -> dict[str, Any]:
    arm = {**cell["arm"], "name": f"a{n}", "mqtt": f"a_{n}", "twin": f"t{n}"}
    return {**cell, "arm": arm, "mobile": {**cell["mobile"], "name": f"m{n}"}}


@views_from(0)
def test_axe_finds_nothing_on_many_cells(crowd: str, eye: Callable[[str], Eye]) -> None:
    eyes = eye(crowd)
    page = eyes.page
    page.wait_for_selector(".crowd > :first-child[data-cell=c7]", state="attached")
    page.wait_for_selector(".for-all [data-act=ready]")
    eyes.look("many cells, trouble first")
    assert not page.is_visible("[data-cell=c7] .tree-box")
    page.click(".counts [data-s=aborted] a")
    page.wait_for_selector("[data-cell=c7].opened .tree-box")
    eyes.look("one of them opened")
    page.click("[data-choose=c7]")
    page.wait_for_selector("[data-cell=c7]:not(.opened)", state="attached")
    assert not eyes.violations, "\n".join(eyes.violations)


@views_from(1)
def test_axe_finds_nothing_on_a_plant_at_work(at_work: str, eye: Callable[[str], Eye]) -> None:
    eyes = eye(at_work)
    page = eyes.page
    page.wait_for_selector('[data-row=done][data-s="done"]', state="attached")
    page.wait_for_selector('[data-row=failed][data-s="failed"]', state="attached")
    for part in PARTS:
        show(page, part)
        eyes.look(part)
    show(page, "tasks")
    page.click("[data-row=failed] a")
    page.wait_for_selector("#task g.node.is-failure")
    eyes.look("a task that failed")
    page.click("#task g.node.is-failure[data-path='0']")
    page.wait_for_selector("#node:visible")
    eyes.look("a node of its tree")
    page.click("#node-close")
    show(page, "cells")
    page.click("[data-choose=sis_b]")
    eyes.look("a cell that nobody gave a task")
    operate(page)
    eyes.look("the menu of the plant")
    operate(page, "sis_a")
    page.click("#faults summary")
    eyes.look("the menu of a cell")
    page.click(".verb[data-verb=home] button")
    page.wait_for_selector("dialog button:focus")
    eyes.look("a question")
    assert not eyes.violations, "\n".join(eyes.violations)


@views_from(0)
def test_axe_finds_nothing_on_a_plant_in_trouble(in_trouble: str, eye: Callable[[str], Eye]) -> None:
    eyes = eye(in_trouble)
    page = eyes.page
    page.click("#stop")
    page.wait_for_selector(".stop-state[data-s=unconfirmed]")
    for part in PARTS:
        show(page, part)
        eyes.look(part)
    operate(page, "left")
    eyes.look("the menu of a cell")
    page.evaluate("window.socket.disconnect()")
    page.wait_for_selector(".silent #connection:not([hidden])")
    eyes.look("no news")
    assert not eyes.violations, "\n".join(eyes.violations)
