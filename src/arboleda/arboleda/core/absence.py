"""Absence of the plant: holds what is at work in a cell until its devices prove what they did meanwhile."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from arboleda.dispatch.belief import Moment
from arboleda.dispatch.ledger import State
from arboleda.model.commands import Motion
from arboleda.model.messages import Failure, Reason

from .cell_states import Cause, CellState

if TYPE_CHECKING:
    from .cell import CellRun


@dataclass(frozen=True, kw_only=True)
class Hold:
    """A hold that ends by itself, `by` s of the plant's time at the latest.

    It ends only while `trouble` is the one that made it, and once each device is seen at rest after `since`;
    `paused` is how the queue was before.
    """

    trouble: Failure
    since: dict[str, Moment]
    by: float
    paused: bool


class Absence:
    """Absence of the plant, to one cell; `hold` is the one that it has made, and that ends by itself."""

    def __init__(self, run: CellRun) -> None:
        self._run = run
        self.hold: Hold | None = None

    def begin(self, failure: Failure) -> None:
        """Hold what is at work, because the plant was away; a cell with nothing under way goes on.

        Where the plant file says so, a held one goes on too, as soon as its devices prove what they did. That
        has to be within the time in which they confirm a stop: later nobody expects a move any more.
        """
        run, context = self._run, self._run.context
        if run.state is CellState.EXECUTE:
            paused = run.queue.paused
            run.halt(Cause.AWAY, failure)
            if run.cell.goes_on_after_absence and run.task is not None:
                by = context.time.plant_now + context.timing.stop_timeout_s
                self.hold = Hold(trouble=failure, since=context.robots.moments(), by=by, paused=paused)
        context.commands.cancel_motions()

    def is_over(self) -> bool:
        """Leave the hold where nothing else is in the way and what was at work is proved; True if so."""
        run, hold = self._run, self.hold
        self.hold = None
        if hold is None or run.trouble is not hold.trouble or run.stranded:
            return False
        if run.context.time.plant_now > hold.by:
            return False
        if run.context.commands.open() or not self._is_proved(hold.since):
            self.hold = hold  # until its devices have reported what they did
            return False
        run.go_on(Cause.RETRY)
        run.queue.paused = hold.paused
        return True

    def _is_proved(self, since: dict[str, Moment]) -> bool:
        """True where its devices are at rest and can work, and what was at work may be given anew.

        A motion whose robot was not heard meanwhile may: it begins wherever the robot stands now.
        """
        run, robots = self._run, self._run.context.robots
        for entry in [act.entry for act in run.run.interrupted() if act.entry is not None]:
            lost = entry.failure is not None and entry.failure.reason is Reason.LINK_LOST
            anew = entry.too_early or (lost and isinstance(entry.command, Motion))
            if entry.state is State.FAILED and not anew:
                return False
        able = all(robots.obstacle(robot.name) is None for robot in run.cell.reached)
        return able and not robots.moving_since(since)
