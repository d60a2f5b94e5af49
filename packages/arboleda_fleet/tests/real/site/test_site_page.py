"""The page on many plants, in a real browser: one plant that runs, and one that does not answer."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.chromium import people
from tests.patience import PATIENCE_MS
from tests.system.conftest import Process, paths
from tests.system.page import connected, running, until
from tests.system.test_accessible import Eye

from arboleda.cli.client import PlantClient

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright", "axe_playwright_python")]
MAIN = "from arboleda.cli.main import main; main()"
NOBODY = "http://127.0.0.1:9"  # a port on which nothing listens


@pytest.fixture(scope="module")
def state(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("site")


@pytest.fixture(scope="module")
def site(state: Path) -> Iterator[str]:
    """The address of the page on a plant that runs and one that is not there."""
    with running(state) as plant:
        command = (MAIN, "site", "--port", "0", plant, NOBODY)
        process = Process(sys.executable, "-c", *command, env={"PYTHONPATH": paths()})
        try:
            process.wait_for("Ctrl-C ends it")
            yield next(line.split()[-1] for line in process.lines if line.startswith("Page:"))
            assert process.interrupt() == 0, process.output
            assert "Traceback" not in process.output, process.output
        finally:
            process.kill()


@pytest.fixture
def page(browser: Any, site: str) -> Iterator[Any]:
    """A phone in Spanish; a script that fails fails the test."""
    with people(browser) as new:
        made = new(viewport={"width": 360, "height": 740}, locale="es")
        made.goto(site)
        connected(made)
        yield made


def row(name: str, words: str) -> str:
    return f"[data-rows=plants] [data-row='{name}']:has-text('{words}')"


def test_plants_are_shown_lead_to_their_pages_take_tasks_and_are_stopped(page: Any, state: Path) -> None:
    page.wait_for_selector(row(NOBODY, "no responde"))
    page.wait_for_selector(row("arboleda", "inactiva"))
    rows = page.eval_on_selector_all("[data-rows=plants] > .row", "all => all.map(each => each.dataset.row)")
    assert rows == [NOBODY, "arboleda"], "trouble comes first"
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    assert "plantas: 2" in page.inner_text("[data-live=sum]")
    eye = Eye(page)
    eye.look("plants")
    assert eye.violations == []

    with page.context.expect_page() as opened:
        page.click("[data-row=arboleda] a")
    opened.value.set_default_timeout(PATIENCE_MS)
    connected(opened.value)
    assert opened.value.inner_text("h1") == "arboleda"
    opened.value.close()

    page.select_option("#site-plant", "arboleda")
    page.fill("#site-text", "sis_a palletizing #site1")
    page.click("#site-send")
    page.wait_for_selector("#answer:has-text('arboleda ha aceptado sis_a palletizing (#site1)')")
    until(lambda: PlantClient(state).task("site1")["state"] == "done")
    page.fill("#site-text", "sis_z palletizing")
    page.click("#site-send")
    page.wait_for_selector("#answer[data-s=bad]:has-text('sis_z')")

    page.click("#stop")
    page.wait_for_selector(f"#answer[data-s=bad]:has-text('SIN PARAR'):has-text('{NOBODY}')")
    page.wait_for_selector(row("arboleda", "parada"))
    assert all(cell["state"] == "aborted" for cell in PlantClient(state).status()["cells"])
    page.click("[data-row=arboleda] [data-act=stop]")
    page.wait_for_selector("#answer[data-s=good]:has-text('arboleda ha recibido el paro')")
