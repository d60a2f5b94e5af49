from __future__ import annotations

import io
from typing import Any

import pytest
from rich.console import Console

from arboleda.app.screen import Screen, joints, parting, table
from arboleda.core.messages import Reason, TaskChanged, TaskState
from arboleda.core.model import MotionState
from arboleda.testing import Rig, shipped


@pytest.fixture
def rig() -> Rig:
    rig = Rig(shipped())
    rig.wait(0.5)
    for text in ("sis_a 0B 7", "sis_a 0B 3", "sis_b 1C 3", "sis_c 2A 5"):
        rig.submit(text)
    assert rig.wait(9.0, until=lambda: rig.snapshot()["cells"][0]["step"] == "move to pick-up")
    return rig


def drawn(snapshot: dict[str, Any], width: int) -> str:
    console = Console(file=io.StringIO(), width=width)
    console.print(table(snapshot))
    return console.file.getvalue()  # type: ignore[attr-defined]


def test_the_table_fits_eighty_columns(rig: Rig) -> None:
    text = drawn(rig.snapshot(), 80)
    assert "…" not in text
    for words in ("sis_a 0B 7 +1", "move to pick-up", "sis_b 1C 3", "drive path 2A", "node 7", "off"):
        assert words in text


def test_joints_are_shown_in_degrees_then_millimetres() -> None:
    assert joints({"q": (0.7854, 0.1745, 0.05), "units": ["rad", "rad", "m"]}) == "45 10° 50 mm"
    assert joints({"q": None, "units": None}) == "?"


def test_a_held_cell_says_why_and_what_to_do(rig: Rig) -> None:
    rig.lost = lambda publication: publication.topic == "ra_1/sensores"
    rig.wait(9.0)
    text = " ".join(drawn(rig.snapshot(), 80).split())
    assert "sis_a is held (ra1 is offline); retry sis_a recovers" in text


def test_latched_robots_are_told_in_one_line(rig: Rig) -> None:
    snapshot = rig.snapshot()
    robots = {robot["name"]: robot for robot in snapshot["robots"]}
    for name in ("ra1", "rm_sis_a"):
        robots[name].update(latched=True, obstacle=f"{name} is stopped")
    snapshot["cells"][0].update(task=None, step=None, state="aborted", held_by=None)
    text = drawn(snapshot, 80)
    assert "stop (software) latched: ra1, rm_sis_a; clear, then reset" in text
    assert "aborted" in text and "is stopped" not in text


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


def test_a_failed_change_shows_sentence_and_reason(rig: Rig) -> None:
    console = Console(file=io.StringIO(), width=100)
    change = TaskChanged(
        task="t-1",
        text="sis_a 0B 7",
        cell="sis_a",
        state=TaskState.FAILED,
        reason=Reason.LINK_LOST,
        sentence="ra1: no [bold]link[/]",
    )
    Screen(console, rig.snapshot).changed(change)
    assert console.file.getvalue() == "failed    sis_a 0B 7  ra1: no [bold]link[/] (link_lost)\n"  # type: ignore[attr-defined]
