from __future__ import annotations

import io
import logging
import time
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console
from rich.text import Text

from arboleda.cli import screen as shown
from arboleda.cli.screen import Screen, joints, logged, parting, table
from arboleda.model.messages import MotionState, Reason, TaskChanged, TaskState, Verb
from arboleda.runtime.parts.plant_log import task_line
from arboleda.testing import Rig, shipped
from arboleda.views import view

from ..kinds.lab import Bench, model
from ..kinds.test_people import asking


@pytest.fixture
def rig() -> Rig:
    rig = Rig(shipped())
    rig.wait(0.5)
    for text in ("sis_a 0B 7", "sis_a 0B 3", "sis_b 1C 3", "sis_c 2A 5"):
        rig.submit(text)
    rig.wait_for("sis_a", "move to pick-up", 9.0)
    return rig


def drawn(snapshot: dict[str, Any], width: int) -> str:
    console = Console(file=io.StringIO(), width=width)
    console.print(table(snapshot))
    return console.file.getvalue()  # type: ignore[attr-defined]


def test_the_table_fits_eighty_columns(rig: Rig) -> None:
    text = drawn(rig.snapshot(), 80)
    assert "…" not in text
    rows = " ".join(text.split())
    for words in (
        "sis_a execute 0B 7 +1 move to pick-up",
        "sis_b execute 1C 3",
        "drive path 2A",
        "node 7",
        "off",
    ):
        assert words in rows


def test_joints_are_shown_in_degrees_then_millimetres() -> None:
    assert joints({"q": (0.7854, 0.1745, 0.05), "units": ["rad", "rad", "m"]}) == "45 10° 50 mm"
    assert joints({"q": (0.05, -0.2), "units": ["m", "m"]}) == "50 mm -200 mm"


def test_a_held_cell_says_why_and_what_to_do(rig: Rig) -> None:
    rig.lost = lambda publication: publication.topic == "ra_1/sensores"
    rig.wait(9.0)
    text = " ".join(drawn(rig.snapshot(), 80).split())
    assert "sis_a is held (ra1 was lost); bring ra1 back, then retry sis_a or abandon sis_a" in text


def test_latched_robots_are_told_in_one_line(rig: Rig) -> None:
    snapshot = rig.snapshot()
    robots = {robot["name"]: robot for robot in snapshot["robots"]}
    for name in ("ra1", "rm_sis_a"):
        robots[name].update(latched=True, obstacle=f"{name} is stopped")
    snapshot["cells"][0].update(task=None, step=None, state="aborted", held_by=None)
    text = drawn(snapshot, 80)
    assert "stop (software) latched: ra1, rm_sis_a; clear, then reset" in text
    assert "aborted" in text and "is stopped" not in text


def test_a_cell_that_is_stopped_is_told_to_be_reset(rig: Rig) -> None:
    for verb in (Verb.STOP, Verb.CLEAR):
        rig.operate(verb, "sis_a")
        rig.wait(3.0)
    assert "sis_a is stopped; reset sis_a" in drawn(rig.snapshot(), 80)


def test_what_was_answered_to_the_task_that_runs_is_told() -> None:
    here = asking()
    assert "heard" not in drawn(here.snapshot(), 100)
    assert here.operate(Verb.ANSWER, "ana", answer="yes") is None
    assert "tending heard: ana, Is the pallet full again?: yes" in drawn(here.snapshot(), 100)


def test_a_question_is_told_with_the_command_of_each_answer() -> None:
    here = asking()
    here.wait(10.0)
    lines = [line.strip() for line in drawn(here.snapshot(), 100).splitlines()]
    at = lines.index("ana is asked, 50 s left: Is the pallet full again?")
    ids = [
        f"--question {robot['question']['id']}" for robot in here.snapshot()["robots"] if robot["question"]
    ]
    (asked,) = ids
    assert lines[at + 1 :] == [
        f"arboleda answer {asked} ana yes",
        f"arboleda answer {asked} ana 'no parts left'",
    ]
    assert here.operate(Verb.ANSWER, "ana", answer="yes") is None
    assert "is asked" not in drawn(here.snapshot(), 100)


def test_an_answer_that_begins_like_an_option_can_be_typed() -> None:
    snapshot = asking().snapshot()
    person = next(robot for robot in snapshot["robots"] if robot["question"])
    person["question"]["answers"] = ["-1"]
    assert f"arboleda answer --question {person['question']['id']} -- ana -1" in drawn(snapshot, 100)


def test_a_question_is_told_once_where_there_is_no_terminal(tmp_path: Path) -> None:
    here = asking()
    console = Console(file=io.StringIO(), width=120)
    screen = Screen(console, here.snapshot, tmp_path / "log")
    for _ in range(3):
        screen.stepped(here.snapshot(), 0.0)
        here.wait(1.0)
    said = console.file.getvalue()  # type: ignore[attr-defined]
    assert said.count("is asked") == said.count(" ana yes") == 1


def test_zones_show_who_is_in_them_and_who_waits(rig: Rig) -> None:
    zones = [
        {"zone": "middle", "state": "quarantined", "robot": "ra1", "waiting": ["ra2", "ra3"]},
        {"zone": "door", "state": "free", "robot": None, "waiting": []},
    ]
    rows = [line.split() for line in drawn({**rig.snapshot(), "zones": zones}, 80).splitlines()]
    assert ["middle", "quarantined", "ra1", "ra2,", "ra3"] in rows
    assert ["door", "free"] in rows


def test_how_each_robot_was_left_is_told(rig: Rig) -> None:
    snapshot = rig.snapshot()
    robots = {robot["name"]: robot for robot in snapshot["robots"]}
    robots["ra1"].update(state=MotionState.MOVING.value)
    robots["ra2"].update(online=False)
    robots["ra3"].update(age_s=None)
    lines = parting(snapshot)
    assert "ra1: NOT confirmed still, effector off" in lines
    assert "ra2: offline, not known to be still, effector off" in lines
    assert not any(line.startswith("ra3") for line in lines)


def line(change: TaskChanged) -> logging.LogRecord:
    values = {"msg": task_line(change), "levelno": logging.INFO, "change": change}
    return logging.makeLogRecord(values)


FAILED = TaskChanged(
    task="t-1",
    text="sis_a 0B 7",
    cell="sis_a",
    state=TaskState.FAILED,
    reason=Reason.LINK_LOST,
    sentence="ra1: no [bold]link[/]",
)


def test_a_failed_change_shows_sentence_and_reason(rig: Rig) -> None:
    console = Console(file=io.StringIO(), width=100, force_terminal=True, color_system=None)
    Screen(console, rig.snapshot, Path("arboleda.log")).say(logged(line(FAILED)), at=0.0)
    assert console.file.getvalue() == "failed    sis_a 0B 7  ra1: no [bold]link[/] (link_lost)\n"  # type: ignore[attr-defined]


def test_the_state_of_a_task_has_its_colour() -> None:
    spans = [(span.start, span.end, span.style) for span in logged(line(FAILED)).spans]
    assert spans == [(0, 9, "bold red"), (10, 20, "bold")]


def test_where_no_person_looks_on_every_line_says_its_time(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    console = Console(file=io.StringIO(), width=100)
    screen = Screen(console, rig.snapshot, Path("arboleda.log"))
    screen.say(logged(line(FAILED)), at=1_700_000_000.9)
    screen.stepped(rig.snapshot(), at=1_700_000_001.0)
    first, step, *_ = console.file.getvalue().splitlines()  # type: ignore[attr-defined]
    assert first.startswith("2023-11-14 22:13:20 failed    sis_a 0B 7")
    assert step == "2023-11-14 22:13:21   sis_a: move to pick-up"


def test_a_file_that_standard_output_goes_to_does_not_grow_for_ever(
    rig: Rig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shown, "OUTPUT_BYTES", 2000)
    with (tmp_path / "out").open("w", buffering=1) as out:
        screen = Screen(Console(file=out, width=80), rig.snapshot, Path("arboleda.log"))
        for number in range(500):
            screen.say(Text(f"line {number}"), at=0.0)
        whole = (tmp_path / "out").read_text()
        assert len(whole) < 2200 and "they go on in arboleda.log" in whole.splitlines()[-1]
        out.truncate(0)
        screen.say(Text("room again"), at=0.0)
    assert "room again" in (tmp_path / "out").read_text()


def test_texts_of_a_snapshot_are_no_markup_and_nothing_that_a_terminal_obeys(rig: Rig) -> None:
    snapshot = rig.snapshot()
    evil = "[red]x[/red]\x1b[2J\u202e"
    snapshot["plant"] = evil
    snapshot["cells"][1]["held_by"] = evil
    snapshot["cells"][2]["step"] = evil
    text = drawn(snapshot, 200)
    assert "\x1b" not in text and "\u202e" not in text
    assert text.count("[red]x[/red]\\x1b[2J") == 3


def test_an_idle_cell_that_cannot_work_says_so(rig: Rig) -> None:
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET):
        rig.operate(verb, "sis_a")
        rig.wait(2.0)
    text = drawn(rig.snapshot(), 100)
    assert "paused" in text and "resume sis_a starts it" in " ".join(text.split())
    rig.power_off("rm_sis_a")
    rig.wait(3.0)
    text = drawn(rig.snapshot(), 100)
    assert "blocked" in text
    assert text.count("rm_sis_a is offline") == 1, "once is enough"
    assert "bring rm_sis_a back, then resume sis_a" in " ".join(text.split())


def test_devices_that_go_nowhere_are_told_with_their_facts() -> None:
    bench = Bench(model())
    bench.submit("bench bake 10")
    assert bench.wait(30.0, lambda: bench.told[-1:] == ["oven bake"])
    bench.wait(1.0)
    bench.plant.dispatcher.beliefs["oven"].facts.pop("dose")
    rows = [" ".join(line.split()) for line in drawn(view.snapshot(bench.plant), 120).splitlines()]
    assert "bench execute bake 10 oven bake 10 2.7 s" in rows
    assert "bench oven oven at work lid closed, clamped yes, dose ? doing bake 10: running" in rows
    assert "bench eye eye still doing look: done, good" in rows
    assert parting(view.snapshot(bench.plant)) == ["oven: NOT confirmed still, clamped yes", "eye: still"]
