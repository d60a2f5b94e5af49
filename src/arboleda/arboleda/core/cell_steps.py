"""Waits of a cell in states that it leaves by itself, and the ways out of them.

These functions are asked again and again, whenever something may have happened to the cell. So they note
what they find only once, and their answer is whether they did anything: a cell that always says so would
never come to rest (`Rounds.go`).
"""

from __future__ import annotations

from collections.abc import Callable

from arboleda.dispatch.ledger import State
from arboleda.model.cell_states import Cause, CellState
from arboleda.model.messages import Failure, Reason
from arboleda.model.sentence import Phrase
from arboleda.resume.walk_back import NO_PART

from .cell import CellRun

STOP_UNCONFIRMED = Phrase("cell.stop_unconfirmed", "{robots} did not confirm the stop")
CLEAR_UNCONFIRMED = Phrase("cell.clear_unconfirmed", "{robots} did not confirm the clear")


def _halted(run: CellRun) -> bool:
    """Leave `holding` once no motion is open."""
    if any(entry.halts for entry in run.context.commands.open()):
        return False
    run.become(Cause.HALTED)
    run.note(_fault(run))
    _miss_part(run)
    return True


def _cleared(run: CellRun) -> bool:
    """Leave `clearing` once no robot says any more that it is stopped."""
    if run.context.robots.latched():
        return False
    run.become(Cause.CLEARED)
    return True


def _found_unsettled(run: CellRun) -> bool:
    """Leave `idle` where an effector may hold a part, unless the cell is taught: a teacher grips parts."""
    if run.manual.teaching is not None:
        return False
    unsettled = run.readiness.part_in_hand()
    if unsettled is None or run.context.commands.open():
        return False
    run.stuck(unsettled)
    return True


def _settled(run: CellRun) -> bool:
    """Leave `held` where only a part in an effector was the trouble; else note faults that come meanwhile."""
    if waits_for_grip(run) and not run.context.parts.holding:
        run.leave_as_it_is()
        return True
    if run.keeping.walk is not None:
        return run.judge()
    if run.task is not None and run.trouble is None:
        run.note(_fault(run))
    _miss_part(run)
    return run.absence.hold is not None and _absence_is_over(run)


def waits_for_grip(run: CellRun) -> bool:
    """True while only a part in a gripper holds a cell: it is idle once the part is out."""
    trouble = run.trouble if run.state is CellState.HELD and run.task is None else None
    return trouble is not None and trouble.reason is Reason.INTERRUPTED


def _miss_part(run: CellRun) -> None:
    """Note where anybody has opened an effector with a part of the task."""
    if run.task is None or run.stranded:
        return
    gone = run.context.failures.opened_effector()
    if gone is not None:
        run.lose(NO_PART(arm=run.context.parts.opened_by or ""), gone)


def _absence_is_over(run: CellRun) -> bool:
    """Leave the hold that an absence of the plant has made, where nothing else is in its way."""
    hold = run.absence.end(None if run.stranded else run.trouble)
    if hold is None:
        return False
    run.go_on(Cause.RETRY)
    run.queue.paused = hold.paused
    return True


def clear(run: CellRun) -> None:
    """Begin to clear a cell whose robots were told that their stop is over."""
    run.become(Cause.CLEAR)
    run.stop_by = run.context.time.now + run.context.timing.stop_timeout_s


def outlast(run: CellRun, failure: Failure) -> None:
    """Hold a cell at work, because the plant was away. An idle cell goes on: nothing was interrupted.

    Where the plant file says so, the hold ends by itself once the devices prove what they did.
    """
    if run.state is CellState.EXECUTE:
        paused = run.queue.paused
        run.halt(Cause.AWAY, failure)
        if run.cell.goes_on_after_absence and run.task is not None:
            run.absence.begin(failure, paused=paused)
    run.context.commands.cancel_motions()


def _aborted(run: CellRun) -> bool:
    """Leave `aborting` once every online robot is seen still, or the time for it is over."""
    moving = run.context.robots.moving_since(run.stopped_after)
    if moving and run.context.time.now < run.stop_by:
        return False
    if moving:
        sentence = STOP_UNCONFIRMED(robots=tuple(moving))
        run.note(Failure(reason=Reason.STOP_UNCONFIRMED, sentence=sentence))
    run.become(Cause.HALTED)
    return True


def _fault(run: CellRun) -> Failure | None:
    """The fault that came during a hold: an interrupted step that failed, a robot that takes no command."""
    for act in run.run.interrupted():
        entry = act.entry
        if entry is not None and entry.state is State.FAILED and not entry.too_early:
            return entry.failure
    obstacles = (run.context.robots.obstacle(robot.name, was=True) for robot in run.cell.reached)
    return next((failure for failure in obstacles if failure), None)


WAITS: dict[CellState, Callable[[CellRun], bool]] = {
    CellState.HOLDING: _halted,
    CellState.ABORTING: _aborted,
    CellState.CLEARING: _cleared,
    CellState.IDLE: _found_unsettled,
    CellState.HELD: _settled,
}
"""By state that waits for something: the function that leaves the state once that is so."""
