"""Absence of the plant: holds what is at work in a cell until its devices prove what they did meanwhile."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.dispatch.ledger import State
from arboleda.dispatch.stillness import Moment
from arboleda.model.commands import Motion
from arboleda.model.messages import Failure, Reason
from arboleda.trees.context import Context
from arboleda.trees.tree_run import TreeRun


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

    def __init__(self, context: Context, run: TreeRun) -> None:
        self._context = context
        self._run = run
        self.hold: Hold | None = None

    def begin(self, failure: Failure, *, paused: bool) -> None:
        """Have the hold for this failure end as soon as the devices of the cell prove what they did.

        That has to be within the time in which they confirm a stop: later nobody expects a move any more.
        """
        context = self._context
        by = context.time.plant_now + context.timing.stop_timeout_s
        self.hold = Hold(trouble=failure, since=context.robots.moments(), by=by, paused=paused)

    def end(self, trouble: Failure | None) -> Hold | None:
        """End the hold where what was at work is proved, and return it; None where the cell stays held.

        `trouble` is why the cell is held now: for another one it does not go on by itself any more.
        """
        hold, self.hold = self.hold, None
        if hold is None or trouble is not hold.trouble or self._context.time.plant_now > hold.by:
            return None
        if self._context.commands.open() or not self._is_proved(hold.since):
            self.hold = hold  # until its devices have reported what they did
            return None
        return hold

    def _is_proved(self, since: dict[str, Moment]) -> bool:
        """True where its devices are at rest and can work, and what was at work may be given anew.

        A motion whose robot was not heard meanwhile may: it begins wherever the robot stands now.
        """
        robots = self._context.robots
        for entry in [act.entry for act in self._run.interrupted() if act.entry is not None]:
            lost = entry.failure is not None and entry.failure.reason is Reason.LINK_LOST
            anew = entry.too_early or (lost and isinstance(entry.command, Motion))
            if entry.state is State.FAILED and not anew:
                return False
        able = all(robots.obstacle(robot.name) is None for robot in self._context.cell.reached)
        return able and not robots.moving_since(since)
