"""What is drawn of one robot: measured, estimated, silent, or nowhere."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.dashboard.twin.track import Track

ARM = {"speeds": [1.0, 1.0]}
NODES = [[0.0, 0.0], [0.2, 0.0], [0.4, 0.0]]
MOBILE = {"speeds": [0.2, 0.2], "nodes": NODES}
KNOWN = {
    "q": (0.1, 0.2),
    "node": None,
    "position_at": 10.0,
    "heard_at": 10.0,
    "online": True,
    "homed": True,
    "reports": True,
    "goal": None,
    "going_since": None,
    "reached": None,
}
MUTE = KNOWN | {"q": None, "position_at": None, "heard_at": None, "reports": False}
ON_NODE = KNOWN | {"q": None, "node": 0}
GOAL = {"q": [0.1, 1.2]}
WAY = {"nodes": [0, 1, 2]}


def seen(row: dict[str, Any], now: float = 10.0, robot: dict[str, Any] = ARM) -> dict[str, Any]:
    return Track(robot).see(row, now)


def test_what_was_reported_is_drawn_as_it_was_reported() -> None:
    assert seen(KNOWN) == {"kind": "measured", "q": [0.1, 0.2], "estimate": None, "goal": None, "age": None}


def test_between_reports_an_estimate_runs_ahead_of_what_was_measured() -> None:
    drawn = seen(KNOWN | {"goal": GOAL, "going_since": 9.0}, now=10.1)
    assert drawn["q"] == [0.1, 0.2] and drawn["goal"] == GOAL["q"]
    assert drawn["estimate"] == pytest.approx([0.1, 0.3])


def test_an_estimate_begins_no_earlier_than_the_move() -> None:
    assert seen(KNOWN | {"goal": GOAL, "going_since": 10.08}, now=10.1)["estimate"] is None


def test_a_command_that_nobody_has_accepted_moves_nothing() -> None:
    drawn = seen(KNOWN | {"goal": GOAL}, now=10.5)
    assert (drawn["estimate"], drawn["goal"]) == (None, GOAL["q"])


def test_a_silent_robot_stays_where_it_was_heard_last_and_grows_older() -> None:
    drawn = seen(KNOWN | {"online": False, "goal": GOAL, "going_since": 9.0}, now=25.9)
    assert (drawn["kind"], drawn["q"], drawn["age"], drawn["estimate"]) == ("stale", [0.1, 0.2], 15, None)


@pytest.mark.parametrize(
    ("changed", "kind"),
    [({"q": None}, "unknown"), ({"homed": False}, "unhomed"), ({"homed": False, "online": False}, "stale")],
)
def test_a_place_that_means_nothing_is_not_called_measured(changed: dict[str, Any], kind: str) -> None:
    assert seen(KNOWN | changed)["kind"] == kind


def test_a_mobile_is_on_the_node_it_reported_and_its_estimate_at_most_on_the_next() -> None:
    track = Track(MOBILE)
    going = ON_NODE | {"goal": WAY, "going_since": 10.0}
    track.see(going, 10.0)
    assert track.see(going, 10.5)["estimate"] == pytest.approx([0.1, 0])
    assert track.see(going, 19.0)["estimate"] == pytest.approx([0.2, 0])
    arrived = track.see(going | {"node": 1}, 19.0)
    assert (arrived["q"], arrived["estimate"], arrived["goal"]) == (NODES[1], None, NODES[2])
    assert track.see(going | {"node": 1}, 19.25)["estimate"] == pytest.approx([0.25, 0])


def test_a_robot_that_reports_no_joints_is_nowhere_until_a_move_was_proven() -> None:
    track = Track(ARM)
    assert track.see(MUTE, 0.0)["kind"] == "unknown"
    assert track.see(MUTE | {"goal": GOAL, "going_since": 0.0}, 1.0)["kind"] == "unknown"
    drawn = track.see(MUTE | {"reached": GOAL}, 2.0)
    assert (drawn["kind"], drawn["q"], drawn["estimate"]) == ("estimated", None, GOAL["q"])


def test_a_robot_that_reports_no_joints_is_estimated_from_its_last_proven_place() -> None:
    track = Track(ARM)
    track.see(MUTE | {"reached": {"q": [0.0, 0.0]}}, 0.0)
    going = MUTE | {"goal": {"q": [2.0, 1.0]}, "going_since": 1.0}
    assert track.see(going, 2.5)["estimate"] == pytest.approx([1.5, 1.0])
    halted = MUTE | {"goal": None}
    assert track.see(halted, 3.0)["estimate"] == pytest.approx([1.5, 1.0])
    back = MUTE | {"goal": {"q": [0.0, 0.0]}, "going_since": 4.0}
    assert track.see(back, 5.0)["estimate"] == pytest.approx([0.5, 0.0])


def test_a_robot_that_stops_to_report_where_it_is_is_estimated_from_there() -> None:
    track = Track(ARM)
    track.see(KNOWN, 10.0)
    going = MUTE | {"goal": GOAL, "going_since": 11.0}
    assert track.see(going, 11.5)["estimate"] == pytest.approx([0.1, 0.7])


def test_a_mobile_that_reports_no_node_is_estimated_along_its_way() -> None:
    track = Track(MOBILE)
    track.see(MUTE | {"reached": {"node": 0}}, 0.0)
    assert track.see(MUTE | {"goal": WAY, "going_since": 0.0}, 1.5)["estimate"] == pytest.approx([0.3, 0.0])


def test_a_lost_link_of_a_robot_that_reports_no_joints_is_not_called_an_estimate() -> None:
    track = Track(ARM)
    track.see(MUTE | {"reached": GOAL}, 0.0)
    drawn = track.see(MUTE | {"reached": GOAL, "online": False, "heard_at": 5.0}, 9.0)
    assert (drawn["kind"], drawn["q"], drawn["age"]) == ("stale", GOAL["q"], 4)
