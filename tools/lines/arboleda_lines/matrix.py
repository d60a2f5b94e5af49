"""Matrix of bad lines in virtual time: a driver, a form, a moment of an order, and a person's act then.

The plant, the supervisor and the driver are the shipped ones. What must hold in each case: no order begins
after its stop was confirmed or its task has ended, a stop is on the line at once, nothing is done twice, done
is not said of what was not done, and the cell is led out by the first advice each time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import product
from typing import Protocol, runtime_checkable

from arboleda.drivers.supervisor import Give
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Stop, StopMode, Work
from arboleda.model.messages import MotionState, Reason, TaskState, Verb
from arboleda_driver_faults.rig import Result, Rig, World
from arboleda_driver_faults.rigs import rig_of

from .drivers import TRIED, Tried, never
from .line import FORMS, OF_BYTES, TIMED, Form, Line

MOMENTS = ("written", "sent", "at_work", "ended", "reconnect")
ACTS: tuple[Verb | None, ...] = (None, Verb.STOP, Verb.CANCEL)
AROUND = (0.9, 1.1)  # shares of each time that the driver waits for an answer
SHORT_SHARE, LONG_SHARE = 0.5, 3.0  # and of the longest of them
ACT_AFTER_S = 0.05
READY_S, DONE_S = 60.0, 120.0
SLACK_S = 0.001
STANDS = (MotionState.STOPPED, MotionState.STOP_LATCHED)
MAY_FAIL_BY = {*Reason} - {Reason.PART_LOST, Reason.INTERNAL}
"""Reasons of which a bad line may make a task fail: all but what is not so."""


@runtime_checkable
class Lined(Protocol):
    """Driver and virtual device with a line between them."""

    line: Line

    def cut(self) -> None:
        """End the connection."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """One case: a driver's name, a form, a moment and an act."""

    driver: str
    form: Form
    moment: str
    act: Verb | None

    def __str__(self) -> str:
        return f"{self.driver}, {self.form}, {self.moment}, {self.act.value if self.act else 'no act'}"


@dataclass(kw_only=True)
class Outcome:
    """Outcome of a case: breaches, none where all held, and the time until a stop was on the line, s."""

    case: Case
    breaches: list[str] = field(default_factory=list)
    stop_on_line_s: float | None = None


def forms_of(tried: Tried) -> Iterator[Form]:
    """The forms of a driver's line, those with a delay in steps around each of its times."""
    for word in FORMS:
        if word in OF_BYTES and not tried.has_bytes:
            continue
        if word == "echo" and not tried.is_serial:
            continue
        longest_s = max(tried.waits_s)
        around = [share * time_s for time_s in tried.waits_s for share in AROUND]
        delays = sorted({*around, SHORT_SHARE * longest_s, LONG_SHARE * longest_s})
        for delay_s in delays if word in TIMED else (0.0,):
            yield Form(word=word, delay_s=round(delay_s, 3))


def cases_of(name: str, tried: Tried) -> Iterator[Case]:
    for form, moment, act in product(forms_of(tried), MOMENTS, ACTS):
        yield Case(driver=name, form=form, moment=moment, act=act)


class BadLine(World):
    """World of one case."""

    def __init__(self, case: Case, tried: Tried, rig: Rig) -> None:
        self._case, self._tried = case, tried
        self.outcome = Outcome(case=case)
        self._is_on, self._waits_for_order = False, False
        self._where: object = None  # of the robot, at the end of the step before
        self._stop_given_at: float | None = None  # to one that moves, while the line is bad
        self._at_stop: object = None  # where the robot was as its stop was confirmed
        self._ends = self._told_at_end = self._given_at_end = 0
        super().__init__(rig, Result(seed=0, faults=()), tasks=2)

    # The story.

    def run(self) -> Result:
        self._expect("it was not ready", self.advance(READY_S, until=self._is_ready))
        self.submit(self.rig.task(0))
        self._reach(self._case.moment)
        if self._case.act is not None:
            self.advance(ACT_AFTER_S)
            self.operate(self._case.act)
        self.advance(self._tried.lasts_s)
        self._line.end()
        # Until then answers of before are on their way, or are found to be missing.
        self.advance(self._case.form.delay_s + max(self._tried.waits_s))
        self._is_on = False
        self._lead_out()
        told, given = self.rig.moves()
        self._expect(f"{told} orders were begun, and {given} were given", told <= given)
        self.outcome.breaches += self.result.breaches
        self._look_at_stop_on_line()
        return self.result

    def _reach(self, moment: str) -> None:
        if moment in ("written", "sent"):
            self._waits_for_order = True
            self.advance(READY_S, until=lambda: self._is_on)
            return
        at_rest = self.rig.where
        self.advance(READY_S, until=lambda: self.rig.where != at_rest)
        if moment == "ended":
            self.advance(READY_S, until=self._stands())
        elif moment == "reconnect":
            self._loopback.cut()
        self._begin()

    def _stands(self) -> Callable[[], bool]:
        """True once the robot is where it was at the look before."""
        before: list[object] = [None]

        def looked() -> bool:
            here = self.rig.where
            stands, before[0] = here == before[0], here
            return stands

        return looked

    def _begin(self) -> None:
        self._is_on = True
        self._line.begin(self._case.form)

    def _lead_out(self) -> None:
        """Follow the first advice until the cell is ready; its next task is done."""
        self._expect("no advice led out", self.advance(DONE_S, until=self._is_ready))
        self.submit(self.rig.task(1))
        ended = len(self.result.ended)
        self.advance(DONE_S, until=lambda: len(self.result.ended) > ended)
        states = [each.state for each in self.result.ended[ended:]]
        self._expect("the task after it was not done", states == [TaskState.DONE])

    # What happens.

    @property
    def _loopback(self) -> Lined:
        assert isinstance(self._driver, Lined)
        return self._driver

    @property
    def _line(self) -> Line:
        return self._loopback.line

    def _is_ready(self) -> bool:
        cell = self.plant.cells[self._cell.name]
        open_tasks = cell.task is not None or bool(cell.queue)
        return cell.state is CellState.IDLE and not open_tasks and not self.plant.advice(self._cell.name)

    def _give(self, give: Give) -> None:
        command = give.command
        is_first = self._waits_for_order and isinstance(command, Work)
        if is_first and self._case.moment == "written":
            self._begin()
        is_stop = isinstance(command, Stop) and command.mode is not StopMode.CLEAR
        if is_stop and self._is_on and self._stop_given_at is None and self.rig.where != self._where:
            self._stop_given_at = self.now
        super()._give(give)
        if is_first:
            self._waits_for_order = False
            if self._case.moment == "sent":
                self._begin()

    def _attend(self) -> None:
        if not self._is_on:
            super()._attend()

    def _pass_time(self) -> None:
        self._where = self.rig.where
        super()._pass_time()
        self._look_at_stop()
        self._look_at_end()

    def _possible(self) -> set[Reason]:
        return set(MAY_FAIL_BY)

    # What must hold.

    def _expect(self, what: str, holds: bool) -> None:
        if not holds:
            self.outcome.breaches.append(what)

    def _look_at_stop(self) -> None:
        """A robot that is heard, and confirmed to be stopped, stays where it is until it is cleared."""
        state = self.plant.cells[self._cell.name].state
        belief = self.plant.dispatcher.beliefs[self.rig.robots[0].name]
        is_confirmed = belief.online and belief.stillness.is_sure and belief.state in STANDS
        if not is_confirmed or state not in (CellState.ABORTED, CellState.STOPPED):
            self._at_stop = None
        elif self._at_stop is None:
            self._at_stop = self.rig.where
        elif self.rig.where != self._at_stop:
            self._expect("it moved after its stop was confirmed", False)
            self._at_stop = self.rig.where

    def _look_at_end(self) -> None:
        """No order leaves after its task has ended, unless another one was given since."""
        told, given = self.rig.moves()
        if len(self.result.ended) != self._ends:
            self._ends, self._told_at_end, self._given_at_end = len(self.result.ended), told, given
        elif self._ends and given == self._given_at_end and told > self._told_at_end:
            self._expect("an order left after its task had ended", False)
            self._told_at_end = told

    def _look_at_stop_on_line(self) -> None:
        given_at = self._stop_given_at
        if given_at is None or self._tried.is_stop is never:
            return
        said = (at for at, message in self._line.asked if at >= given_at and self._tried.is_stop(message))
        on_line_at = next(said, None)
        if on_line_at is None:
            return  # there was no connection, or nothing to stop any more
        self.outcome.stop_on_line_s = on_line_at - given_at
        late = self.outcome.stop_on_line_s > self._tried.telegram_s + SLACK_S
        self._expect(f"the stop was on the line after {on_line_at - given_at:.3f} s", not late)


def tried(case: Case) -> Outcome:
    """Run one case."""
    world = BadLine(case, TRIED[case.driver], rig_of(case.driver))
    world.run()
    return world.outcome
