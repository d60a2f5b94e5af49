"""A plant that is killed finds again what it accepted, whoever asks."""

from __future__ import annotations

import json
import shlex
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ..patience import PATIENCE_MS
from .conftest import paths
from .page import connected, running

pytestmark = pytest.mark.system

UP = ("up", "--no-ros", "--rate", "10")


def kept(arboleda: Callable[..., Any]) -> dict[str, str]:
    """The state of each task that the plant has ever taken, by its text."""
    listed = arboleda("tasks", "--json")
    assert listed.wait() == 0, listed.output
    rows = [json.loads(line) for line in listed.lines]
    return {row["text"]: row["state"] for row in rows}


@pytest.mark.smoke
def test_a_killed_plant_loses_no_task_and_does_none_twice(arboleda: Callable[..., Any]) -> None:
    first = arboleda(*UP, "sis_a 0B 1 #one", "sis_a 0B 2 #two", "sis_a 0B 3 #three")
    first.wait_for("done      sis_a 0B 1")
    first.wait_for("running   sis_a 0B 2")
    first.kill()
    assert kept(arboleda) == {"sis_a 0B 1": "done", "sis_a 0B 2": "running", "sis_a 0B 3": "queued"}

    second = arboleda(*UP, "sis_b 0B 4")
    second.wait_for("task two was at work when the plant stopped, at its step")
    second.wait_for("1 task of an earlier start waits in sis_a; resume sis_a starts it")
    second.wait_for("done      sis_b 0B 4")
    refused = arboleda("resume", "sis_a")  # its boards were in the process that was killed
    assert refused.wait() == 2 and "abandon sis_a" in refused.output
    assert arboleda("abandon", "sis_a").wait() == 0
    second.wait_for("failed    sis_a 0B 2")
    again = arboleda("submit", "sis_a 0B 1 #one")
    assert again.wait() == 0 and "done: sis_a 0B 1" in again.output
    assert kept(arboleda)["sis_a 0B 3"] == "queued"
    second.interrupt()
    assert kept(arboleda)["sis_a 0B 3"] == "queued"


def test_a_disk_that_gets_full_ends_the_plant_which_has_kept_all_that_it_accepted(
    arboleda: Callable[..., Any],
    start: Callable[..., Any],
    typed: Callable[..., tuple[int, str]],
    tmp_path: Path,
) -> None:
    """The limit for the size of files stands for the disk."""
    command = [sys.executable, "-c", "from arboleda.cli.main import main; main()", *UP]
    limited = f"ulimit -f 150; exec {shlex.join([*command, '--state', str(tmp_path / 'state')])}"
    plant = start("bash", "-c", limited, env={"PYTHONPATH": paths()})
    plant.wait_for("HTTP API")
    accepted = []
    for number in range(200):
        status, _ = typed("submit", f"sis_a 0B 1 #lot{number}")
        if status != 0:
            break
        accepted.append(f"lot{number}")
    assert plant.wait() == 1
    assert "arboleda: The plant's memory" in plant.lines[-1] and "disk" in plant.lines[-1]
    listed = arboleda("tasks", "--json", "--limit", "1000")
    assert listed.wait() == 0, listed.output
    assert {json.loads(line)["id"] for line in listed.lines} >= set(accepted) and accepted


@pytest.mark.requires("chromium", "playwright")
def test_the_page_finds_tasks_of_an_earlier_start_and_shows_the_oee_that_the_command_says(
    arboleda: Callable[..., Any], browser: Any, tmp_path: Path
) -> None:
    many = [f"sis_{cell} 0B {1 if cell == 'a' else number}" for number in range(1, 9) for cell in "abc"]
    first = arboleda("up", "--once", "--no-ros", "--rate", "50", *many)
    assert first.wait() == 0, first.output
    listed = arboleda("oee", "--json")
    assert listed.wait() == 0, listed.output
    said = {row["cell"]: row for row in map(json.loads, listed.lines)}
    assert said["sis_a"]["done"] == said["sis_a"]["timed"] == 8 and said["sis_b"]["missing"]
    with running(tmp_path / "state") as address:
        page = browser.new_context(locale="en").new_page()
        page.set_default_timeout(PATIENCE_MS)
        page.goto(f"{address}/?tab=tasks")
        connected(page)
        rows = "[data-rows=history] .row"
        page.wait_for_function(f"document.querySelectorAll('{rows}').length === 20")
        page.click("#history-more")
        page.wait_for_function(f"document.querySelectorAll('{rows}').length === 24")
        page.fill("#history-words", "sis_b 0b")
        page.wait_for_function(f"document.querySelectorAll('{rows}').length === 8")
        assert page.locator("#history-more").is_hidden()
        page.fill("#history-words", "nothing like this")
        page.get_by_text("No task was kept.").wait_for()

        shares = [said["sis_a"][name] for name in ("oee", "availability", "performance", "quality")]
        row = page.locator("[data-rows=oee] [data-row=sis_a]")
        row.wait_for()
        shown = [row.locator(f".column-{number}").inner_text() for number in range(1, 5)]
        assert shown == [f"{100 * share:.0f} %" for share in shares]
        page.select_option("#oee-hours", "1")
        page.wait_for_function("document.querySelectorAll('[data-rows=oee] .row').length === 3")
