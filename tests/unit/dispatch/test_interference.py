"""Labels of commands on their way, and until when one of somebody else may be why something happened."""

from __future__ import annotations

from dataclasses import dataclass, replace

import pytest

from arboleda.dispatch.interference import Interferences
from arboleda.dispatch.outlet import labelled
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command, Home, Motion
from arboleda.model.messages import Report


@pytest.mark.parametrize(("after_s", "named"), [(0.0, True), (5.0, True), (5.1, False)])
def test_a_robot_reports_within_five_seconds_what_an_obeyed_command_did(after_s: float, named: bool) -> None:
    known = Interferences()
    known.note("ra1", "ra1: effector_cmd 0 of another node was obeyed", 10.0, obeyed=True)
    assert (known.lately_obeyed("ra1", 10.0 + after_s) is not None) is named


def test_what_was_refused_has_done_nothing() -> None:
    known = Interferences()
    known.note("ra1", "ra1: effector_cmd 0 of another node was refused", 10.0, obeyed=False)
    assert known.lately_obeyed("ra1", 10.0) is None


@pytest.mark.parametrize("kind", ["refused", "obeyed"])
def test_a_count_is_news_when_it_rises_and_says_nothing_of_the_other(kind: str) -> None:
    known, said = Interferences(), {"foreign": "ra1: home_cmd of /teleop", f"foreign_{kind}": 1}
    news = (kind == "refused", kind == "obeyed")
    assert known.rise(Report(at=1.0, robot="ra1", epoch=1, **said)) == news
    assert known.rise(Report(at=2.0, robot="ra1", epoch=1, **said)) == (False, False)
    assert known.rise(Report(at=3.0, robot="ra1", epoch=2, **said)) == news


def test_each_command_of_others_has_the_next_number_and_the_last_twenty_are_kept() -> None:
    known = Interferences()
    for at in range(22):
        known.note("ra1", "ra1: effector_cmd 0 of another node was refused", float(at), obeyed=False)
    assert [each.number for each in known.noticed] == list(range(3, 23))


@pytest.mark.parametrize(
    ("accepted", "number"),
    [
        ("7-3", None),
        ("7-4", 4),
        ("6-9999", None),
        ("7-x", None),
        (None, None),
        ("7-9999999999", 9_999_999_999),
    ],
)
def test_a_command_of_this_start_above_the_last_that_was_given_is_forged(
    accepted: str | None, number: int | None
) -> None:
    known = Interferences()
    report = Report(at=1.0, robot="ra1", accepted=accepted)
    assert known.forged(report, 7, 3) == number
    assert known.forged(report, 7, 3) is None


@dataclass(frozen=True, slots=True, kw_only=True)
class Slide(Motion):
    """A motion of somebody's own kind, whose values are in slots."""

    by_m: float


COMMANDS = [
    MoveJoints(id="7-1", robot="ra1", q=(0.0, 0.5)),
    FollowPath(id="7-2", robot="rm1", nodes=(0, 3)),
    SetEffector(id="7-3", robot="ra1", on=True),
    Home(id="7-4", robot="ra1"),
    Slide(id="7-5", robot="ra1", by_m=0.2),
]


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: type(command).__name__)
def test_labels_are_put_on_a_copy_that_is_equal_but_for_them(command: Command) -> None:
    sent = labelled(command, heard=4, token="a1b2c3000500")
    assert type(sent) is type(command)
    assert sent == replace(command, heard=4, token="a1b2c3000500")
    assert (command.heard, command.token) == (None, None)
    assert sent.given == command.given
