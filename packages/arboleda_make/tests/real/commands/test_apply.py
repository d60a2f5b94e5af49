"""A change of the plant file of a plant that runs, put to work by commands as a person types them."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.system.page import until

from arboleda.runtime.state import find_running

pytestmark = pytest.mark.system

EXAMPLE = Path(__file__).parents[5] / "examples/own_tree"
Typed = Callable[..., tuple[int, str]]


def test_what_changed_since_the_start_is_said_and_a_restart_at_rest_has_it(
    arboleda: Callable[..., Any], typed: Typed, tmp_path: Path
) -> None:
    plant = copied(tmp_path)
    up = arboleda("up", "--no-ros", "--plant", str(plant))
    up.wait_for("HTTP API")
    plant.write_text(plant.read_text("utf-8").replace("takes_s: 20", "takes_s: 25"), "utf-8")
    applied = arboleda("apply", "--plant", str(plant), "--yes")
    assert applied.wait() == 0, applied.output
    assert "compared with what the plant was started with" in applied.output
    assert "kind mill, run.takes_s: from 20 to 25" in applied.output
    assert "this needs a restart" in applied.output
    assert at_work(typed, plant) == ["  1  "]
    again = arboleda("apply", "--plant", str(plant), "--yes", "--restart")
    assert again.wait() == 0 and "restarts with it once all its cells rest" in again.output, again.output
    until(lambda: up.output.count("HTTP API: ") == 2)
    assert "all its cells rest" in up.output
    assert at_work(typed, plant) == ["  2  "]
    assert up.interrupt() == 0


def test_a_plant_that_runs_takes_a_change_when_its_task_has_ended_and_its_record_is_replayed(
    arboleda: Callable[..., Any], typed: Typed, tmp_path: Path
) -> None:
    plant = copied(tmp_path)
    up = arboleda("up", "--no-ros", "--plant", str(plant), "--rate", "10")
    up.wait_for("HTTP API")
    assert typed("submit", "--plant", str(plant), "cell slot_1 1001")[0] == 0
    up.wait_for("running ")
    moved(plant, "-75.52", "-75.5")
    tend = tmp_path / "tend.xml"
    tend.write_text(tend.read_text("utf-8").replace('num_attempts="2"', 'num_attempts="3"'), "utf-8")
    applied = arboleda("apply", "--plant", str(plant), "--yes")
    assert applied.wait() == 0, applied.output
    assert "cell takes it when task t-" in applied.output or "cell takes it now" in applied.output
    up.wait_for("cell works by version 2 from now on")
    assert typed("submit", "--plant", str(plant), "--wait", "cell slot_2 1002")[0] == 0
    assert at_work(typed, plant) == ["  2  "]
    put = by_signal(up, plant, "-75.5,", "-75.4,")
    assert "version 3 was put to work by SIGHUP" in put
    assert up.interrupt() == 0
    replayed = arboleda("record", "replay", *map(str, sorted((tmp_path / "state" / "record").glob("*.mcap"))))
    assert replayed.wait() == 0 and "all equal" in replayed.output, replayed.output


def test_a_plant_that_is_killed_while_a_change_is_put_to_work_has_all_of_it_next_or_nothing(
    arboleda: Callable[..., Any], typed: Typed, tmp_path: Path
) -> None:
    plant = copied(tmp_path)
    up = arboleda("up", "--no-ros", "--plant", str(plant))
    up.wait_for("HTTP API")
    moved(plant, "-75.52", "-75.5")
    assert arboleda("apply", "--plant", str(plant), "--yes").wait() == 0
    up.kill()
    # As a kill between two files leaves it: version 1 is brought back, and one of its files is written.
    kept = tmp_path / ".arboleda" / "plant.yaml"
    (kept / "bringing_back").write_text("1", "ascii")
    (tmp_path / "tend.xml").write_text("cut off", "utf-8")
    again = arboleda("up", "--no-ros", "--plant", str(plant))
    again.wait_for("HTTP API")
    assert plant.read_bytes() == (EXAMPLE / "plant.yaml").read_bytes()
    assert (tmp_path / "tend.xml").read_bytes() == (EXAMPLE / "tend.xml").read_bytes()
    assert not (kept / "bringing_back").exists() and at_work(typed, plant) == ["  1  "]
    assert again.interrupt() == 0


def moved(plant: Path, before: str, after: str) -> None:
    """Change a number of the plant file as a person does who edits it."""
    text = plant.read_text("utf-8")
    assert before in text
    plant.write_text(text.replace(before, after), "utf-8")


def by_signal(up: Any, plant: Path, before: str, after: str) -> str:
    """The sentence of the plant once it has taken an edited file by SIGHUP."""
    moved(plant, before, after)
    running = find_running(plant.parent / "state")
    assert running is not None
    os.kill(running.pid, signal.SIGHUP)
    up.wait_for("cell works by version 3 from now on")
    return str(up.output)


def copied(folder: Path) -> Path:
    """The plant file of a copy of the example."""
    for name in ("plant.yaml", "tend.xml"):
        (folder / name).write_bytes((EXAMPLE / name).read_bytes())
    return folder / "plant.yaml"


def at_work(typed: Typed, plant: Path) -> list[str]:
    """The numbers of the versions that are listed as at work, as they begin their lines."""
    status, listed = typed("apply", "--list", "--plant", str(plant))
    assert status == 0, listed
    return [line[:5] for line in listed.splitlines() if "at work" in line]
