"""Hold of a cell after an absence of the plant: it ends once devices prove what they did meanwhile."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.dispatch.ledger import State
from arboleda.dispatch.stillness import ReportMoment
from arboleda.model.commands import Motion
from arboleda.model.messages import Failure, Reason
from arboleda.trees.context import Context
from arboleda.trees.tree_run import TreeRun


@dataclass(frozen=True, kw_only=True)
class Hold:
    """Hold that ends by itself once each device is seen at rest after `since`.

    It does so until `by` s of the plant's time. `trouble` is why the cell was held; `paused`: its queue was
    paused before.
    """

    trouble: Failure
    since: dict[str, ReportMoment]
    by: float
    paused: bool


class HoldAfterAbsence:
    """Hold of one cell after an absence of the plant; `hold` is None where none ends by itself."""

    def __init__(self, context: Context, run: TreeRun) -> None:
        self._context = context
        self._run = run
        self.hold: Hold | None = None

    def begin(self, failure: Failure, *, paused: bool) -> None:
        """Have the hold for this failure end as soon as the devices of the cell prove what they did.

        They have the time in which they confirm a stop: robots that move later would surprise people.
        """
        context = self._context
        by = context.time.plant_now + context.timing.stop_timeout_s
        self.hold = Hold(trouble=failure, since=context.robots.moments(), by=by, paused=paused)

    def end(self, trouble: Failure | None) -> Hold | None:
        """End the hold where devices prove what they did, and return it; None where the cell stays held.

        `trouble` is why the cell is held by now. A cell that got another trouble never goes on by itself.
        """
        hold, self.hold = self.hold, None
        if hold is None or trouble is not hold.trouble or self._context.time.plant_now > hold.by:
            return None
        if self._context.commands.open() or not self._is_proved(hold.since):
            self.hold = hold  # its devices have not reported yet what they did
            return None
        return hold

    def _is_proved(self, since: dict[str, ReportMoment]) -> bool:
        """True where the devices rest and can work, and each command that failed may be given anew.

        A command that was never taken may, and a motion whose link was lost: it begins where the robot is.
        A process or a switch may not, since it may have been done.
        """
        robots = self._context.robots
        for entry in [act.entry for act in self._run.interrupted() if act.entry is not None]:
            lost = entry.failure is not None and entry.failure.reason is Reason.LINK_LOST
            anew = entry.too_early or (lost and isinstance(entry.command, Motion))
            if entry.state is State.FAILED and not anew:
                return False
        able = all(robots.obstacle(robot.name) is None for robot in self._context.cell.reached)
        return able and not robots.moving_since(since)
