"""Booking of verdicts on commands: feeds the ledger, and does what follows for their robots."""

from __future__ import annotations

from dataclasses import replace

from arboleda.model import refusals
from arboleda.model.commands import FRESH_S, Command, Home, Motion, StopMode, Switch, Work
from arboleda.model.grips import Grip
from arboleda.model.messages import Failure, MotionState, Reason, Report
from arboleda.model.sentence import BOTH, Phrase, Sentence

from .belief import Belief
from .effectors import Effectors
from .evidence import CommandVerdict
from .ledger import Entry, Feed, Ledger, State
from .outlet import Outlet
from .time_limits import TimeLimits
from .underway import UnderWay, Unfinished
from .whereabouts import Whereabouts

NOT_FINISHED = Phrase("command.not_finished", "{robot}: did not finish within {seconds:.1f} s while {doing}")
NOT_STOPPED = Phrase(
    "command.not_stopped", "{robot}: did not confirm that it stopped within {seconds:.1f} s while {doing}"
)
BROKEN_OFF = frozenset({Reason.LINK_LOST, Reason.REBOOTED, Reason.STOPPED, Reason.CANCELLED, Reason.INTERNAL})
"""Reasons from outside, for which a command failed that its device might have carried out."""
KNOWN_STILL = frozenset({Reason.STOPPED_SHORT, Reason.NOT_REACHED, Reason.STOPPED})


class Booking:
    """Booking of verdicts on commands.

    `doubtful` has, by robot, the facts that a failed command was to set: their next reports may be too old.
    `rejected` says how often a robot refused a command, and why it did so last.
    """

    def __init__(
        self,
        *,
        beliefs: dict[str, Belief],
        ledger: Ledger,
        effectors: Effectors,
        outlet: Outlet,
        under_way: UnderWay,
        unfinished: Unfinished,
        whereabouts: Whereabouts,
        limits: TimeLimits,
    ) -> None:
        self.doubtful: dict[str, set[str]] = {}
        self.rejected: dict[str, tuple[int, Sentence | None]] = {}
        self._beliefs = beliefs
        self._ledger = ledger
        self._effectors = effectors
        self._outlet = outlet
        self._under_way = under_way
        self._unfinished = unfinished
        self._whereabouts = whereabouts
        self._limits = limits
        self._proven: dict[str, str] = {}  # by robot, the last command that is done

    def book(self, entry: Entry, verdict: CommandVerdict, now: float) -> None:
        """Feed the ledger with a verdict, and halt a robot whose motion failed and may still be under way."""
        before = entry.state
        entry.answer = verdict.answer
        failure = None if verdict.failure is None else _explained(entry, verdict.failure)
        self._ledger.feed(entry.command.id, verdict.feed, now, failure)
        self._ledger.version += entry.state is not before
        if entry.state in (State.DONE, State.CANCELLED):
            self._under_way.ended(entry.command)
        if entry.state is State.FAILED and _lets_go(entry.command) and not was_broken_off(entry):
            self._effectors.unopened.add(entry.command.robot)
        if entry.state is State.DONE:
            self._done(entry.command)
        elif verdict.feed is Feed.REJECTED:
            self._reject(entry.command, verdict.failure)
        failed = entry.state is State.FAILED and verdict.feed is not Feed.REJECTED
        if failed:
            self._doubt(entry)
        called_off = entry.state is State.CANCELLED and verdict.feed is Feed.HALTED and not verdict.failure
        if failed or called_off:
            self._expect_late(entry, verdict, now)
        if failed and entry.halts and verdict.failure and verdict.failure.reason not in KNOWN_STILL:
            self._outlet.stop(entry.command.robot, StopMode.HALT)

    def end_overdue(self, entry: Entry, now: float) -> None:
        """Book the end of a command whose time is over: done where it needs no report, else failed."""
        verdict = _overdue(entry)
        entry.settled = verdict.feed is Feed.DONE
        self.book(entry, verdict, now)

    def refused_after_all(self, report: Report) -> None:
        """Note that a robot is stopped, by its refusal of a command that its facts had proven before."""
        robot = report.robot
        if report.refusal != refusals.STOPPED or report.rejected != self._proven.get(robot):
            return
        del self._proven[robot]
        belief = self._beliefs[robot]
        belief.barred |= belief.state is not MotionState.STOP_LATCHED

    def give_up(self, cell: str, failure: Failure, now: float) -> None:
        """Fail every open command of a cell, and halt what moves, since nobody judges them any more."""
        for entry in self._ledger.of_cell(cell):
            self.book(entry, CommandVerdict(feed=Feed.FAILED, failure=failure), now)

    def undelivered(self, id: str, robot: str, sentence: Sentence, now: float) -> None:
        """Fail a command that could not leave this process; one that was being cancelled is cancelled."""
        failure = Failure(reason=Reason.LINK_LOST, sentence=sentence)
        for entry in self._ledger.of_robot(robot):
            if entry.command.id == id:
                self._effectors.grips.will_not_open(robot, id)
                if entry.command.makes_part:
                    self._effectors.unmake(robot)
                feed = Feed.HALTED if entry.state is State.CANCELLING else Feed.FAILED
                self.book(entry, CommandVerdict(feed=feed, failure=failure), now)

    def _expect_late(self, entry: Entry, verdict: CommandVerdict, now: float) -> None:
        """Expect that a device may still carry out a command that is over for the plant.

        Reports from before the command came show the device at rest, so they prove nothing of it.
        """
        lasts_s = 0.0 if _ended_by_boot(verdict) else _arrives_s(entry, now)
        if entry.state is State.FAILED and _may_go_on(entry, verdict):
            lasts_s += self._limits.allowed_s(entry.command, self._limits.timings[entry.cell])
        if lasts_s > 0:
            self._unfinished.expect(entry.command, lasts_s, now)

    def _doubt(self, entry: Entry) -> None:
        """Take reports of the facts of a failed command for too old, until a later command has set them."""
        if entry.sets:
            facts = self.doubtful.setdefault(entry.command.robot, set())
            facts.update(name for name, _ in entry.sets)

    def _reject(self, command: Command, failure: Failure | None) -> None:
        robot = command.robot
        if command.makes_part:
            self._effectors.unmake(robot)
        count, _ = self.rejected.get(robot, (0, None))
        self.rejected[robot] = (count + 1, failure.sentence if failure else None)
        belief, stopped = self._beliefs[robot], failure is not None and failure.reason is Reason.STOPPED
        belief.barred |= stopped and belief.state is not MotionState.STOP_LATCHED

    def _done(self, command: Command) -> None:
        self._proven[command.robot] = command.id
        if doubtful := self.doubtful.get(command.robot):
            doubtful.difference_update(name for name, _ in command.sets)
        if command.robot in self._unfinished.by_device:
            self._unfinished.done(command)
        belief = self._beliefs[command.robot]
        if not belief.stillness.is_sure and isinstance(command, Work):
            belief.stillness.be_sure()
        if isinstance(command, Switch) and command.grips is not None:
            self._effectors.set(command.robot, Grip.ON if command.grips else Grip.OFF)
        elif isinstance(command, Motion) and command.way:
            self._whereabouts.arrive(command.robot, command.way[-1])
        elif isinstance(command, Home):
            self._whereabouts.displace(belief, displaced=False)


def was_broken_off(entry: Entry) -> bool:
    """True for a command that was halted, or failed for a reason outside of its device."""
    return entry.failure is None or entry.failure.reason in BROKEN_OFF


def _may_go_on(entry: Entry, verdict: CommandVerdict) -> bool:
    """True where a device may carry out a failed command to its end.

    A boot ends every command, and work that can be halted is halted. But where the link was lost, nobody
    knows whether the command, or the report of its beginning, is still on its way.
    """
    lost = verdict.failure is not None and verdict.failure.reason is Reason.LINK_LOST
    return lost if entry.halts else not _ended_by_boot(verdict)


def _ended_by_boot(verdict: CommandVerdict) -> bool:
    return verdict.failure is not None and verdict.failure.reason is Reason.REBOOTED


def _arrives_s(entry: Entry, now: float) -> float:
    """The time (s) in which a command that its device has not accepted may still get there."""
    return 0.0 if entry.accepted_at is not None else max(0.0, entry.sent_at + FRESH_S - now)


def _lets_go(command: Command) -> bool:
    return isinstance(command, Switch) and command.grips is False


def _explained(entry: Entry, failure: Failure) -> Failure:
    """The failure; where a command of somebody else may have caused it, its sentence says so."""
    if entry.interference is None:
        return failure
    return replace(failure, sentence=BOTH(first=failure.sentence, second=entry.interference))


def _overdue(entry: Entry) -> CommandVerdict:
    if entry.settles_at is not None and entry.settles_at <= entry.deadline:
        return CommandVerdict(feed=Feed.DONE)
    stopping = entry.state is State.CANCELLING
    what = NOT_STOPPED if stopping else NOT_FINISHED
    waited = entry.deadline - (entry.cancelled_at if entry.cancelled_at is not None else entry.sent_at)
    sentence = what(robot=entry.command.robot, seconds=waited, doing=entry.doing)
    reason = Reason.STOP_UNCONFIRMED if stopping else Reason.DEADLINE
    return CommandVerdict(feed=Feed.FAILED, failure=Failure(reason=reason, sentence=sentence))
