"""The page on a record, from `arboleda record replay --page` and beside the plant that writes it."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from tests.chromium import people
from tests.patience import PATIENCE_S
from tests.system.conftest import Process, paths
from tests.system.page import connected, running, show, until
from tests.system.test_accessible import Eye, eye, views_from

from arboleda.cli.client import PlantClient
from arboleda.model.messages import Verb
from arboleda.recorder import reader
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.files import FOLDER, parts_in
from arboleda_proofs.playback.views import Views

__all__ = ["eye"]  # a fixture

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

MAIN = "from arboleda.cli.main import main; main()"
AT = "[data-live='record.at']"
WRONG_EVENTS = [[], ["go", "x"], ["go", 1e99], ["step", 7], ["task", {"a": 1}], ["__class__"], [["go"], 1]]
"""Requests that no button of the page sends."""
FAILED = "article.cell.chosen g.node.is-failure"


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, Path]]:
    """A plant where one task was done and one failed, and its state directory; its record has both.

    It begins with a plant at rest: the tasks come once that is on the disk.
    """
    state = tmp_path_factory.mktemp("recorded")
    with running(state, "--rate", "4") as address:
        client = PlantClient(state)
        until(lambda: is_recorded(state))
        client.submit("sis_a 0B 7 #done")
        client.submit("sis_c 2A 5 #failed")
        until(lambda: client.status()["cells"][2]["step"] == "drive path 2A")
        client.operate(Verb.STOP, "sis_c")
        until(lambda: kept(state) >= {("done", "done"), ("failed", "failed")})
        yield address, state


def is_recorded(state: Path) -> bool:
    """True once the record has its first view."""
    parts = parts_in(state / FOLDER)
    try:
        return bool(parts) and Views(reader.opened(parts[0].path)).began_ns > 0
    except NoRecord:  # nothing is on the disk yet
        return False


def kept(state: Path) -> set[tuple[str, str]]:
    (part,) = parts_in(state / FOLDER)
    events = Views(reader.opened(part.path)).events()
    return {(each["subject"], each["what"]) for each in events if each["kind"] == "task"}


@pytest.fixture(scope="module")
def replay(plant: tuple[str, Path]) -> Iterator[str]:
    """The address of the page on that record."""
    command = (MAIN, "record", "replay", "--page", "--port", "0", "--state", str(plant[1]))
    process = Process(sys.executable, "-c", *command, env={"PYTHONPATH": paths()})
    try:
        process.wait_for("Ctrl-C ends it.")
        yield next(line.split()[-1] for line in process.lines if line.startswith("Page:"))
        assert process.interrupt() == 0, process.output
        assert len(process.lines) == 2, process.output
    finally:
        process.kill()


@pytest.fixture
def tab(browser: Any) -> Iterator[Any]:
    with people(browser) as new:
        yield new(locale="en")


def look(tab: Any, address: str) -> None:
    tab.goto(address)
    connected(tab)


def moved(tab: Any, act: Any) -> str:
    """Do something that leads to another moment; that moment."""
    before = tab.text_content(AT)
    act()
    tab.wait_for_function(f"document.querySelector(\"{AT}\").textContent !== '{before}'")
    return str(tab.text_content(AT))


def noted(tab: Any) -> str:
    """The address, once it says the moment that is shown."""
    tab.wait_for_function("new URLSearchParams(location.search).get('at')?.includes('.')")
    return str(tab.url)


def test_it_opens_at_the_last_failure_with_the_tree_as_it_was_and_nothing_can_be_done(
    tab: Any, replay: str
) -> None:
    look(tab, f"{replay}&cell=sis_c")
    tab.wait_for_selector(FAILED)
    assert "sis_c" in tab.text_content("[data-live='record.event']")
    assert tab.title() == "Record of arboleda"
    before = moved(tab, lambda: tab.click("[data-past=event_before]"))
    tab.wait_for_selector(FAILED, state="detached")
    tab.wait_for_selector("article.cell.chosen g.node.current")
    assert moved(tab, lambda: tab.keyboard.press("PageDown")) != before
    tab.wait_for_selector(FAILED)
    tab.keyboard.press("PageDown")
    tab.wait_for_selector("#answer:has-text('no failure after that')")

    look(tab, re.sub("at=[^&]*", "at=task&tab=tasks&task=failed", replay))
    tab.wait_for_selector("#task g.node.is-failure")
    assert tab.locator("#stop, form, [data-act], [data-choice]").count() == 0
    origin = replay.partition("/?")[0]
    with httpx.Client(base_url=origin, trust_env=False, timeout=PATIENCE_S) as client:
        assert client.get("/api/plant").status_code == 404
        assert client.get("/", headers={"host": "evil.example"}).status_code == 403


def test_a_moment_is_reached_by_slider_keys_time_line_and_address(
    tab: Any, browser: Any, replay: str
) -> None:
    look(tab, replay)
    before = noted(tab)
    moment = moved(tab, lambda: tab.keyboard.press("ArrowLeft"))
    tab.wait_for_function("before => location.href !== before", arg=before)
    colleague = browser.new_page(locale="es")
    look(colleague, noted(tab).replace("lang=en", "lang=es"))
    assert colleague.text_content(AT) == moment
    colleague.close()

    tab.wait_for_selector("#record-marks i")
    first = moved(tab, lambda: tab.fill("#record-slider", "0"))
    assert tab.text_content("article.cell.chosen .pill").startswith("idle")
    tab.select_option("#record-speed", "4")
    moved(tab, lambda: tab.click("#record-play"))
    tab.wait_for_selector("g.node.current:visible")
    tab.click("#record-play")
    assert tab.text_content(AT) > first
    for event in WRONG_EVENTS:
        tab.evaluate("event => window.emitEvent('arboleda-past', ...event)", event)
    moved(tab, lambda: tab.click("[data-past=event_before]"))

    moved(tab, lambda: tab.fill("#record-slider", tab.get_attribute("#record-slider", "max")))
    show(tab, "events")
    rows = tab.locator("[data-rows=events] .row")
    tab.wait_for_selector("[data-rows=events] .row")
    count = rows.count()
    moved(tab, lambda: tab.click("[data-rows=events] .row:nth-child(6) a"))
    tab.wait_for_function(f"document.querySelectorAll('[data-rows=events] .row').length < {count}")
    show(tab, "cells")
    tab.wait_for_selector("#twin-robots [data-robot=ra1]")
    for value in (tab.get_attribute("#record-slider", "max"), "0"):  # at its end a robot stands on its way
        drawn = tab.evaluate("JSON.stringify(arboledaTwin.drawn())")
        moved(tab, lambda value=value: tab.fill("#record-slider", value))
        tab.wait_for_function("drawn => JSON.stringify(arboledaTwin.drawn()) !== drawn", arg=drawn)


@pytest.mark.requires("axe_playwright_python")
@views_from(1)
def test_axe_finds_nothing_on_a_record(replay: str, eye: Callable[[str], Eye]) -> None:
    eyes = eye(f"{replay}&cell=sis_c")
    eyes.page.wait_for_selector(FAILED)
    for part in ("cells", "tasks", "links", "events"):
        show(eyes.page, part)
        eyes.look(part)
    show(eyes.page, "tasks")
    eyes.page.click("[data-row=failed] a")
    eyes.page.wait_for_selector("#task g.node.is-failure")
    eyes.look("a task that failed")
    eyes.page.click("[data-past=failure_after]")
    eyes.page.wait_for_selector("#answer:not(:empty)")
    eyes.look("no failure after that")
    assert not eyes.violations, "\n".join(eyes.violations)


@pytest.fixture(scope="module")
def reported(plant: tuple[str, Path]) -> str:
    """The same plant, with a report of its failure."""
    folder = plant[1] / "reports"
    folder.mkdir()
    command = (MAIN, "report", "failed", "--state", str(plant[1]), "--output", str(folder / "failed.html"))
    process = Process(sys.executable, "-c", *command, env={"PYTHONPATH": paths()})
    process.wait_for("failed.html has ")
    return plant[0]


def test_a_running_plant_leads_into_its_record_and_back_and_to_its_report(tab: Any, reported: str) -> None:
    look(tab, f"{reported}/?task=failed")
    tab.click("#task .to-record")
    tab.wait_for_selector("#record")
    connected(tab)
    tab.wait_for_selector("#task g.node.is-failure")
    tab.click(".record-leave")
    tab.wait_for_selector("#stop")
    connected(tab)
    show(tab, "cells")
    tab.click("[data-choose=sis_c]")
    tab.click("article.cell.chosen .to-record")
    tab.wait_for_selector("#record")
    connected(tab)
    tab.wait_for_selector(FAILED)

    width = 390
    tab.set_viewport_size({"width": width, "height": 800})
    look(tab, f"{reported}/?cell=sis_c")
    with tab.expect_popup() as opened:
        tab.click("article.cell.chosen .to-report")
    report = opened.value
    report.set_viewport_size({"width": width, "height": 800})
    assert "an operator ended it: stop sis_c" in report.inner_text(".cause")
    assert report.evaluate("document.documentElement.scrollWidth") <= width
    assert report.evaluate("self.origin") == "null", "it reaches nothing of the plant's"
    report.click("#language")
    assert "un operador" in report.inner_text(".cause")
    report.close()
    look(tab, f"{reported}/?tab=tasks&task=failed")
    tab.wait_for_selector("#task .to-report[href='/report?task=failed&lang=en']")
    look(tab, f"{reported}/?tab=tasks&task=done")
    tab.wait_for_selector("#task g.node.is-success")
    assert tab.text_content("#task .to-report") == ""
