"""No command leaves against a need that is not believed: every way through a dispatcher is tried."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import product
from typing import NamedTuple

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.commands import Command, Home, Motion, Process, Query, Switch
from arboleda.model.facts import Facts
from arboleda.model.messages import Fact, Failure, MotionState, Reason, Report
from arboleda.model.plant_model import DriverUse, Evidence, PlantModel, Robot

from ..kinds.tending import plant

SAID: Facts = (("clamped", True), ("lid", "closed"))
MET: Facts = (("clamped", True),)
UNMET: tuple[Facts, ...] = ((("lid", "open"),), (("power", True),))  # said otherwise, and never said


@dataclass(frozen=True, kw_only=True)
class Needing(Command):
    """A command with needs of its own."""

    wanted: Facts = ()

    @property
    def needs(self) -> Facts:
        return self.wanted


@dataclass(frozen=True, kw_only=True)
class Ask(Needing, Query):
    """Asks for an answer."""


@dataclass(frozen=True, kw_only=True)
class Run(Needing, Process):
    """Works."""


@dataclass(frozen=True, kw_only=True)
class Move(Needing, Motion):
    """Moves to no named place."""


@dataclass(frozen=True, kw_only=True)
class Reference(Needing, Home):
    """Runs the homing routine."""


@dataclass(frozen=True, kw_only=True)
class Unclamp(Needing, Switch):
    """Ends what is needed of `clamped`."""

    @property
    def sets(self) -> Facts:
        return (("clamped", False),)


@dataclass(frozen=True, kw_only=True)
class LetGo(Needing, Switch):
    """Lets go of a part."""

    @property
    def grips(self) -> bool:
        return False


KINDS: tuple[type[Needing], ...] = (Ask, Run, Move, Reference, Unclamp, LetGo)


class Situation(NamedTuple):
    """All that a dispatcher asks before a command leaves, besides the command."""

    evidence: Evidence
    state: MotionState
    homed: bool
    stopped: bool  # by an operator
    tool_opens: bool
    work_failed: bool  # nothing has proven its end, and it needs `clamped`
    is_open: type[Needing] | None


SITUATIONS = [
    Situation(*each)
    for each in product(Evidence, MotionState, *[(False, True)] * 4, (None, Ask, Run, Unclamp))
]


@cache
def shop(evidence: Evidence) -> PlantModel:
    """An arm with a tool, whose driver leads it out of a fault by homing."""
    driver = DriverUse(name="own", make=object, facts=("clamped", "lid", "power"), recovers=True)

    def driven(robot: Robot) -> Robot:
        return replace(robot, evidence=evidence, driver=driver) if robot.name == "left" else robot

    whole = plant()
    return replace(whole, cells=tuple(cell.with_robots(driven) for cell in whole.cells))


def dispatcher_in(here: Situation) -> Dispatcher:
    """A dispatcher that has come into this situation."""
    dispatcher = Dispatcher(shop(here.evidence), 7, {Fact.EFFECTOR: {"jaw": "on"}})
    said = partial(Report, robot="left", q=(0.0, 0.0), facts=SAID)
    dispatcher.report(said(at=99.0, state=MotionState.STOPPED, homed=True), 99.0)
    if here.work_failed:
        give(dispatcher, Run, MET)
        dispatcher.booking.give_up("tending", Failure(reason=Reason.INTERNAL, sentence="it broke"), 99.0)
    if here.is_open is not None:
        give(dispatcher, here.is_open, MET)
    if here.tool_opens:
        dispatcher.effectors.command(LetGo(id="7-99", robot="jaw"))
    dispatcher.report(said(at=100.0, state=here.state, homed=here.homed), 100.0)
    if here.stopped:
        dispatcher.latches.latch("left")
    return dispatcher


def give(
    dispatcher: Dispatcher, kind: type[Needing], needs: Facts, *, by_hand: bool = False
) -> Reason | None:
    """Give a command; why it has not left, None where it has."""
    make = partial(kind, robot="left", wanted=needs)
    entry = dispatcher.send(make, "tending", "doing it", 100.0, by_hand=by_hand)
    return entry.failure.reason if entry.failure is not None else None


def asked(dispatcher: Dispatcher, kind: type[Needing], needs: Facts) -> Reason | None:
    """Why a command would not leave now."""
    objection = dispatcher.obstacles.objection(partial(kind, robot="left", wanted=needs))
    return objection.reason if objection is not None else None


READY = {MotionState.STOPPED, MotionState.MOVING}
LEAVE: dict[type[Needing], set[MotionState]] = {
    Ask: {*MotionState} - {MotionState.NO_LINK},
    Run: READY,
    Move: READY,
    Reference: READY | {MotionState.NOT_HOMED, MotionState.FAULT},
    Unclamp: READY,
    LetGo: READY,
}
"""The states in which a command can leave at all where its needs are met."""


def test_no_command_of_a_task_leaves_against_a_need_nor_but_a_query_against_a_stop() -> None:
    leave: dict[type[Needing], set[MotionState]] = {kind: set() for kind in KINDS}
    for here in SITUATIONS:
        dispatcher = dispatcher_in(here)
        for kind in KINDS:
            obstacle, *refused = (asked(dispatcher, kind, needs) for needs in (MET, *UNMET))
            assert refused == [obstacle or Reason.PRECONDITION] * len(UNMET), (here, kind)
            if obstacle is None:
                assert kind is Ask or not here.stopped, here
                leave[kind].add(here.state)
    assert leave == LEAVE


def test_no_release_of_an_operator_leaves_against_a_need() -> None:
    leave = set()
    for here in SITUATIONS:
        dispatcher = dispatcher_in(here)
        refused = [give(dispatcher, LetGo, needs, by_hand=True) for needs in UNMET]
        obstacle = give(dispatcher, LetGo, MET, by_hand=True)
        assert refused == [obstacle or Reason.PRECONDITION] * len(UNMET), here
        if obstacle is None:
            leave.add(here.state)
    assert leave == READY | {MotionState.STOP_LATCHED}
