"""Which commands may still be on their way to an arm that shares zones."""

from __future__ import annotations

from arboleda.app.simulate.request import shared
from arboleda.core.messages import Report
from arboleda.core.underway import PATIENCE_S, UnderWay
from arboleda.kinds.arm import MoveJoints
from arboleda.testing import shipped

MODEL = shared()
ARM = next(cell.arm.name for cell in MODEL.cells if cell.zones)
MOVES = [MoveJoints(id=f"7-{number}", robot=ARM, q=(0.0, 0.0, 0.0)) for number in (1, 2)]


def test_what_left_is_under_way_until_it_or_a_later_one_is_named() -> None:
    under_way = UnderWay(MODEL)
    for move in MOVES:
        under_way.left(move)
    under_way.hear(Report(at=1.0, robot=ARM), 1.0)
    assert under_way.ids == {ARM: ["7-1", "7-2"]}
    under_way.hear(Report(at=1.1, robot=ARM, accepted="7-2"), 1.1)
    assert under_way.ids == {}


def test_what_a_heard_arm_does_not_name_in_time_was_lost() -> None:
    under_way = UnderWay(MODEL)
    under_way.left(MOVES[0])
    under_way.hear(Report(at=1.0, robot=ARM), 1.0)
    assert not under_way.is_overdue(ARM, 1.0)
    assert under_way.is_overdue(ARM, 1.0 + PATIENCE_S)


def test_an_arm_that_shares_nothing_is_not_followed() -> None:
    under_way = UnderWay(shipped("sis_a"))
    under_way.left(MoveJoints(id="7-1", robot="ra1", q=(0.0, 0.0, 0.0)))
    assert under_way.ids == {}
