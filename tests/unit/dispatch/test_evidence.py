"""What reports prove of a command: it is judged as its nearest base, also where its class is from outside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pytest

from arboleda.dispatch.belief import Belief
from arboleda.dispatch.evidence import Before, judge
from arboleda.dispatch.ledger import Entry, Feed
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Command, Home, Motion, Position, Stop, StopMode
from arboleda.model.messages import MotionState, Reason, Report
from arboleda.model.plant_model import Evidence
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout

MOVING, STOPPED = MotionState.MOVING, MotionState.STOPPED
HERE, THERE = (0.0, 0.0, 0.0), (0.5, 0.1, 0.0)


@dataclass(frozen=True, kw_only=True)
class MoveSlowly(MoveJoints):
    """A move of another class."""

    speed: float


@dataclass(frozen=True, kw_only=True)
class Calibrate(Motion):
    """A motion that leads to no named position."""


@dataclass(frozen=True, kw_only=True)
class Sweep(Motion):
    """A motion with a way of its own."""

    @property
    def way(self) -> tuple[Position, ...]:
        return (HERE, THERE, HERE)


def proven(command: Command, level: Evidence, *said: dict[str, Any]) -> list[tuple[Feed, Reason | None]]:
    """What these reports, half a second apart, prove about a command to an arm that stands at HERE."""
    belief = Belief(StorageLayout(shipped("sis_a", evidence=level).cell("sis_a")).arm, 1.5, 1)
    belief.merge(Report(at=-0.1, robot="ra1", state=STOPPED, q=HERE))
    entry = Entry(command, cell="sis_a", doing="moving", sent_at=0.0, deadline=60.0)
    entry.origin = belief.position
    found = []
    for number, words in enumerate(said, start=1):
        report, before = Report(at=0.5 * number, robot="ra1", **words), Before.of(belief)
        belief.merge(report)
        verdict = judge(entry, before, belief, report)
        found += [(verdict.feed, verdict.failure and verdict.failure.reason)] if verdict else []
    return found


@pytest.mark.parametrize("level", Evidence, ids=lambda level: level.value)
def test_a_class_from_outside_is_judged_like_its_base(level: Evidence) -> None:
    told = [
        {"state": MOVING, "q": HERE, "accepted": "1-1"},
        {"state": STOPPED, "q": THERE, "accepted": "1-1", "done": "1-1"},
    ]
    shipped_one = MoveJoints(id="1-1", robot="ra1", q=THERE)
    judged = proven(MoveSlowly(id="1-1", robot="ra1", q=THERE, speed=0.1), level, *told)
    assert judged == proven(shipped_one, level, *told)
    assert judged[-1] == (Feed.DONE, None)


def test_a_motion_without_a_named_goal_is_done_when_its_robot_names_it() -> None:
    told = [{"state": MOVING, "q": HERE, "accepted": "1-1"}, {"state": STOPPED, "q": THERE, "done": "1-1"}]
    assert proven(Calibrate(id="1-1", robot="ra1"), Evidence.IDS, *told)[-1] == (Feed.DONE, None)


def test_a_way_that_ends_where_it_began_has_to_be_seen_driven() -> None:
    stayed = [{"state": MOVING, "q": HERE}, *[{"state": STOPPED, "q": HERE}] * 3]
    driven = [{"state": MOVING, "q": THERE}, *[{"state": STOPPED, "q": HERE}] * 3]
    sweep = Sweep(id="1-1", robot="ra1")
    assert Feed.DONE not in [feed for feed, _ in proven(sweep, Evidence.JOINTS, *stayed)]
    assert Feed.DONE in [feed for feed, _ in proven(sweep, Evidence.JOINTS, *driven)]


@pytest.mark.parametrize("level", [Evidence.JOINTS, Evidence.STATE], ids=lambda level: level.value)
def test_a_row_of_its_own_comes_before_that_of_a_base(level: Evidence) -> None:
    told = [{"state": MOVING, "q": THERE}, *[{"state": STOPPED, "q": HERE}] * 3]
    assert proven(Home(id="1-1", robot="ra1"), level, *told) == []
    assert proven(MoveJoints(id="1-1", robot="ra1", q=HERE), level, *told) != []


def test_a_command_of_no_known_base_is_proven_by_no_report() -> None:
    told = [{"state": MOVING}, {"state": STOPPED, "accepted": "1-1", "done": "1-1"}]
    for level in Evidence:
        assert proven(Stop(id="1-1", robot="ra1", mode=StopMode.HALT), level, *told) == []


MOVE = MoveJoints(id="1-1", robot="ra1", q=THERE)


@pytest.mark.parametrize(
    ("word", "reason"),
    [
        ("no_link", Reason.LINK_LOST),
        ("tarde", Reason.LINK_LOST),
        ("paro", Reason.STOPPED),
        ("sin_ref", Reason.NOT_HOMED),
        ("condicion", Reason.PRECONDITION),
        ("viejo", Reason.REJECTED),
    ],
)
def test_a_refusal_has_its_reason_and_is_of_the_command_that_it_names(word: str, reason: Reason) -> None:
    refused = {"state": STOPPED, "refusal": word}
    assert proven(MOVE, Evidence.IDS, {**refused, "rejected": "1-1"}) == [(Feed.REJECTED, reason)]
    assert proven(MOVE, Evidence.IDS, {**refused, "rejected": "1-0"}) == []


@pytest.mark.parametrize("level", Evidence, ids=lambda level: level.value)
def test_a_command_ends_with_the_link(level: Evidence) -> None:
    assert proven(MOVE, level, {"state": MotionState.NO_LINK}) == [(Feed.FAILED, Reason.LINK_LOST)]


def test_a_command_ends_with_the_boot_of_its_board_and_with_its_bridge() -> None:
    first = {"state": STOPPED, "q": HERE, "boot_id": 1, "epoch": 1}
    assert proven(MOVE, Evidence.IDS, first, first) == []
    assert proven(MOVE, Evidence.IDS, first, {**first, "boot_id": 2}) == [(Feed.FAILED, Reason.REBOOTED)]
    assert proven(MOVE, Evidence.IDS, first, {**first, "epoch": 2}) == [(Feed.FAILED, Reason.LINK_LOST)]


def test_a_jump_that_no_robot_can_make_is_a_boot_where_boots_are_not_told() -> None:
    jumped = {"state": STOPPED, "q": tuple(50.0 * q for q in THERE)}
    assert proven(MOVE, Evidence.JOINTS, jumped) == [(Feed.FAILED, Reason.REBOOTED)]
