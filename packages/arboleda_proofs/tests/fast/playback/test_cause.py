"""Cause of a task's failure, by rules over what the record has of it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from arboleda.dashboard.wording import words
from arboleda.model.messages import MotionState, Reason, Report
from arboleda_proofs.playback.cause import BY_KEY, BY_REASON, PHRASES, Evidence, TaskCommand, cause_of
from arboleda_proofs.playback.troubles import ALARM, BOOT, BRIDGE, SILENCE, Trouble, Troubles

ARM = "ra1"
SENT = TaskCommand(id="7-1", robot=ARM, at=8.0, accepted_at=8.1)
SWITCHED = TaskCommand(id="7-0", robot=ARM, at=7.8, switch=True, accepted_at=7.9)


def trouble(kind: str, at: float, seconds: float = 2.0, **more: Any) -> Trouble:
    return Trouble(**{"kind": kind, "robot": ARM, "at": at, "seconds": seconds, **more})


def named(**changes: Any) -> str:
    known = {"reason": Reason.LINK_LOST, "key": "command.link_lost", "failed_at": 10.0, "robot": ARM}
    cause = cause_of(Evidence(**{**known, "sent": [SENT], **changes}))
    assert str(cause.sentence)
    return cause.kind


@pytest.mark.parametrize(
    ("expected", "changes"),
    [
        ("silence", {"troubles": [trouble(SILENCE, 8.5)]}),
        ("silent", {"troubles": [trouble(SILENCE, 8.5, math.inf)]}),
        ("connection", {"troubles": [trouble(SILENCE, 9.9, lost_at=10.0, cut=True)]}),
        ("boot", {"troubles": [trouble(BOOT, 9.9)]}),
        ("alarm", {"troubles": [trouble(ALARM, 9.9)], "reason": Reason.DEVICE_FAULT}),
        ("bridge", {"troubles": [trouble(BRIDGE, 9.9)]}),
        ("connection", {"troubles": [trouble(BOOT, 1.0)]}),  # long over: what the plant said counts
        ("boot", {"troubles": [trouble(BOOT, 1.0)], "reason": Reason.NOT_HOMED}),
        ("boot", {"inner": "effector.as_rebooted", "key": "effector.opened", "reason": Reason.PART_LOST}),
        ("plant_away", {"absences": [(9.5, 1.2)], "reason": Reason.STOPPED_SHORT}),
        ("short", {"absences": [(5.0, 1.2)], "reason": Reason.STOPPED_SHORT, "key": "x"}),
        ("operator", {"acts": [(9.0, "stop sis_a")], "reason": Reason.STOPPED}),
        ("foreign", {"foreign": [(9.0, ARM)], "reason": Reason.NOT_REACHED}),
        ("off_target", {"foreign": [(9.0, "ra2")], "reason": Reason.NOT_REACHED, "key": "x"}),
        ("unended", {"reason": Reason.DEADLINE}),
        ("short", {"reason": Reason.DEADLINE, "sent": [replace(SENT, moved=True, stands=True)]}),
        ("unheard", {"reason": Reason.DEADLINE, "sent": [TaskCommand(id="7-1", robot=ARM, at=8.0)]}),
        (
            "switch",
            {
                "reason": Reason.DEADLINE,
                "sent": [TaskCommand(id="7-1", robot=ARM, at=8.0, switch=True, accepted_at=8.1)],
            },
        ),
        ("no_part", {"reason": Reason.NO_PIECE, "key": "part.none"}),
        (
            "not_gripped",
            {"reason": Reason.PART_LOST, "key": "part.lost", "failed_at": 8.1, "sent": [SWITCHED, SENT]},
        ),
        ("part_lost", {"reason": Reason.PART_LOST, "key": "part.lost", "failed_at": 8.1}),  # on a later way
        ("part_lost", {"reason": Reason.PART_LOST, "key": "part.lost"}),
        ("foreign", {"reason": Reason.STOPPED}),  # the plant knows of no stop
        ("other", {"reason": Reason.PRECONDITION, "key": "x", "sentence": "nobody knows"}),
        ("other", {"reason": Reason.REJECTED, "key": "own", "robot": None, "sentence": "no clear reading"}),
        (
            "other",
            {
                "reason": Reason.REJECTED,
                "key": "own",
                "robot": None,
                "sentence": "no",
                "absences": [(9.5, 1.2)],
            },
        ),
        ("other", {"reason": Reason.REJECTED, "key": "recipe.other_answer", "sentence": "the scale said so"}),
        ("refused", {"reason": Reason.REJECTED, "key": "command.refused", "word": "ocupado"}),
    ],
)
def test_the_surest_rule_names_the_cause(expected: str, changes: dict[str, Any]) -> None:
    assert named(**changes) == expected


def test_connections_that_break_together_are_the_broker() -> None:
    mine = trouble(SILENCE, 9.9, lost_at=10.0, cut=True)
    other = trouble(SILENCE, 9.8, lost_at=10.1, cut=True, robot="ra2")
    assert named(troubles=[mine, other]) == "broker"


def test_every_cause_has_its_sentence() -> None:
    assert {*BY_KEY.values(), *BY_REASON.values()} <= set(PHRASES)


def report(at: float, **said: Any) -> Report:
    return Report(at=at, robot=ARM, **{"epoch": 5, "boot_id": 1, "state": MotionState.STOPPED, **said})


def found(*reports: Report, now: float = 9.0) -> list[tuple[str, float, float, bool]]:
    troubles = Troubles(frozenset({ARM}), 1.5)
    troubles.take(reports)
    return [(each.kind, each.at, each.seconds, each.cut) for each in troubles.of(now)]


def test_what_befell_a_robot_is_read_out_of_its_reports() -> None:
    lost = MotionState.NO_LINK
    assert found(report(1.0), report(1.5), now=1.6) == []
    assert found(report(1.0), report(2.0), now=2.1) == [(SILENCE, 1.0, 1.0, False)]
    assert found(report(1.0), report(2.5, state=lost), report(3.0), now=3.1) == [(SILENCE, 1.0, 2.0, False)]
    assert found(report(1.0), report(1.1, state=lost), report(1.2), now=1.3)[0][3] is True
    assert found(report(1.0), report(1.1, boot_id=2), now=1.2)[0][0] == BOOT
    assert found(report(1.0), report(1.1, epoch=6, boot_id=2), now=1.2)[0][0] == BRIDGE
    assert found(report(1.0), report(1.1, state=MotionState.FAULT), report(1.2), now=1.3)[0][:2] == (
        ALARM,
        1.1,
    )
    assert found(report(1.0)) == [(SILENCE, 1.0, math.inf, False)]


@pytest.mark.parametrize(
    ("word", "spanish"),
    [
        ("stop ra1", "la terminó un operador, al dar el paro a ra1"),
        ("stop", "la terminó un operador, al dar el paro a la planta"),
        ("cancel sis_a", "la terminó un operador, al cancelar sis_a"),
    ],
)
def test_what_an_operator_did_is_said_in_both_languages(word: str, spanish: str) -> None:
    acts = [(9.0, word)]
    cause = cause_of(
        Evidence(reason=Reason.STOPPED, key="command.stopped", failed_at=10.0, robot=ARM, acts=acts)
    )
    verb, _, scope = word.partition(" ")
    assert str(cause.sentence) == f"an operator ended it: {verb} {scope or 'plant'}"
    assert words("es").say(cause.sentence) == spanish
