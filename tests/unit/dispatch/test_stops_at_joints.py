"""After a stop at `joints` nobody takes for the place of a device what it may have said before that stop."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import pytest

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import APART_S, Evidence, PlantModel
from arboleda.trees.interlocks import Interlocks

from ..kinds.test_interlocks import with_mill

MOVING, STOPPED, LATCHED = MotionState.MOVING, MotionState.STOPPED, MotionState.STOP_LATCHED
LATE_S = 0.007
STOP_AT = 11.0


class Mover(NamedTuple):
    """A device, what it says where it is outside of all zones, and what it says elsewhere."""

    name: str
    outside: dict[str, Any]
    elsewhere: dict[str, Any]


ARM = Mover("left", {"q": (0.0, 0.0)}, {"q": (0.2, 0.1)})
CART = Mover("shuttle", {"node": 0}, {"node": 1})
DOOR = Mover("mill", {"facts": (("door", "open"),)}, {"facts": (("door", "closed"),)})
EACH = pytest.mark.parametrize("mover", [ARM, CART, DOOR], ids=lambda mover: mover.name)


def at_joints(evidence: Evidence = Evidence.JOINTS) -> PlantModel:
    model = with_mill()
    return replace(
        model, cells=tuple(cell.with_robots(partial(replace, evidence=evidence)) for cell in model.cells)
    )


class Floor:
    """A device that has set out from outside of the zones, and what the plant takes it for."""

    def __init__(self, mover: Mover, evidence: Evidence = Evidence.JOINTS) -> None:
        self.mover = mover
        self.dispatcher = Dispatcher(at_joints(evidence), 7, {})
        self.hear(9.9, state=STOPPED, homed=True, **mover.outside)
        self.hear(10.0, state=STOPPED, homed=True, **mover.outside)
        self.hear(10.1, state=MOVING, **mover.outside)

    def hear(self, at: float, **said: Any) -> None:
        self.dispatcher.report(Report(at=at, robot=self.mover.name, **said), at)

    @property
    def is_outside(self) -> bool:
        (cell,) = self.dispatcher.model.cells
        space = cell.workspaces.get(self.mover.name)
        if space is None:
            return not Interlocks(cell, self.dispatcher).occupied_by(self.mover.name)
        return self.dispatcher.whereabouts.place(space) is not None


@EACH
@pytest.mark.parametrize("stopped", [STOPPED, LATCHED, MotionState.FAULT])
def test_a_place_that_is_told_too_soon_after_a_stop_is_not_where_it_stands(
    mover: Mover, stopped: MotionState
) -> None:
    floor = Floor(mover)
    floor.hear(STOP_AT, state=stopped, **mover.outside)
    assert not floor.is_outside
    floor.hear(STOP_AT + LATE_S, **mover.outside)
    assert not floor.is_outside
    floor.hear(STOP_AT + 0.1, **mover.elsewhere)
    floor.hear(STOP_AT + APART_S, **mover.elsewhere)
    assert not floor.is_outside


@EACH
def test_a_place_that_is_told_so_long_after_a_stop_is_where_it_stands_and_its_cell_looks(
    mover: Mover,
) -> None:
    floor = Floor(mover)
    floor.hear(STOP_AT, state=LATCHED, **mover.outside)
    floor.hear(STOP_AT + 0.1, state=LATCHED, **mover.outside)
    floor.dispatcher.ledger.changed.clear()
    floor.hear(STOP_AT + APART_S, state=LATCHED, **mover.outside)
    assert floor.is_outside
    assert floor.dispatcher.ledger.changed == {"tending"}


@EACH
def test_what_is_told_after_a_silence_may_be_older_than_a_stop_that_nobody_heard_of(mover: Mover) -> None:
    floor = Floor(mover)
    floor.hear(10.2, state=MotionState.NO_LINK)
    floor.hear(STOP_AT, state=STOPPED, **mover.outside)
    assert not floor.is_outside
    floor.hear(STOP_AT + APART_S, state=STOPPED, **mover.outside)
    assert floor.is_outside


@EACH
def test_who_names_its_commands_says_all_of_one_instant(mover: Mover) -> None:
    floor = Floor(mover, Evidence.IDS)
    floor.hear(STOP_AT, state=LATCHED, **mover.outside)
    assert floor.is_outside
