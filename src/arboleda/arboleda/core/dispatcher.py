"""Commands out, reports in: owns the ledger and the beliefs, judges the one by the other."""

from __future__ import annotations

from dataclasses import replace

from . import evidence
from .belief import Belief
from .evidence import Before, Verdict
from .leaves import Make
from .ledger import Entry, Feed, Ledger, State
from .messages import (
    Command,
    Failure,
    FollowPath,
    MoveJoints,
    Notice,
    Reason,
    Report,
    SetEffector,
    Stop,
    StopMode,
)
from .model import Arm, Evidence, Mobile, PlantModel

KNOWN_STILL = frozenset({Reason.STOPPED_SHORT, Reason.NOT_REACHED, Reason.STOPPED})


class Dispatcher:
    """Every robot's belief and open commands; `outbox` collects what must leave."""

    def __init__(self, model: PlantModel, epoch: int) -> None:
        self.model = model
        self.epoch = epoch
        self.ledger = Ledger()
        self.outbox: list[Command | Notice] = []
        self.version = 0  # changes whenever something other than a position changed
        stale_after_s = model.timing.stale_after_s
        self.beliefs = {name: Belief(robot, stale_after_s, epoch) for name, robot in model.robots.items()}
        self._count = 0

    @property
    def next_deadline(self) -> float | None:
        stale = [belief.stale_at for belief in self.beliefs.values()]
        return min((at for at in (self.ledger.next_deadline, *stale) if at is not None), default=None)

    def send(self, make: Make, cell: str, doing: str, now: float) -> Entry:
        """Give a command its id and let it go, unless its robot is not ready for one."""
        command = make(id=self._new_id())
        deadline = now + self._allowed_s(command)
        entry = Entry(command, cell=cell, doing=doing, sent_at=now, deadline=deadline)
        obstacle = self._obstacle(command)
        if obstacle is not None:
            entry.refuse(replace(obstacle, sentence=f"{obstacle.sentence}: no {doing}"))
            return entry
        entry.settles_at = self._settles_at(command, now)
        self.ledger.open(entry)
        self.outbox.append(command)
        return entry

    def cancel(self, entry: Entry, now: float) -> None:
        """Ask an open command to end; a motion is halted."""
        self.ledger.feed(entry.command.id, Feed.CANCEL, now)
        entry.deadline = now + self.model.timing.stop_timeout_s
        if entry.is_motion:
            self._halt(entry.command.robot)

    def cancel_all(self, cell: str, now: float) -> None:
        """Ask every command of a cell that is not yet ending to end."""
        for entry in list(self.ledger.entries.values()):
            if entry.cell == cell and entry.state is not State.CANCELLING:
                self.cancel(entry, now)

    def report(self, report: Report, now: float) -> None:
        """Merge a report and book what it proves; reports of unknown robots are ignored."""
        belief = self.beliefs.get(report.robot)
        if belief is None:
            return
        before, obstacle = Before.of(belief), belief.obstacle()
        belief.merge(report)
        for entry in self.ledger.of_robot(report.robot):
            verdict = evidence.judge(entry, before, belief, report)
            if verdict is not None:
                self._book(entry, verdict, now)
        self.version += belief.obstacle() != obstacle

    def undelivered(self, id: str, robot: str, sentence: str, now: float) -> None:
        """Fail a command that could not leave this process."""
        failure = Failure(reason=Reason.LINK_LOST, sentence=sentence)
        for entry in self.ledger.of_robot(robot):
            if entry.command.id == id:
                self._book(entry, Verdict(feed=Feed.FAILED, failure=failure), now)

    def expire(self, limit: float, now: float) -> None:
        """End what is due up to and including `limit`: settling times, deadlines, silence."""
        for entry in [entry for entry in self.ledger.entries.values() if entry.next_deadline <= limit]:
            self._book(entry, _overdue(entry), now)
        for belief in self.beliefs.values():
            if belief.stale_at is not None and belief.stale_at <= limit:
                self._went_stale(belief, now)

    def _new_id(self) -> str:
        self._count += 1
        return f"{self.epoch}-{self._count}"

    def _halt(self, robot: str) -> None:
        self.outbox.append(Stop(id=self._new_id(), robot=robot, mode=StopMode.HALT))

    def _obstacle(self, command: Command) -> Failure | None:
        moving = any(entry.is_motion for entry in self.ledger.of_robot(command.robot))
        if moving and not isinstance(command, SetEffector):
            return Failure(reason=Reason.REJECTED, sentence=f"{command.robot} has an open motion command")
        return self.beliefs[command.robot].obstacle()

    def _allowed_s(self, command: Command) -> float:
        """How long a command may take: by its distance, never below the robot's `timeout_s`."""
        timing, robot = self.model.timing, self.model.robots[command.robot]
        if isinstance(command, MoveJoints) and isinstance(robot, Arm):
            travel_s = robot.travel_s(self.beliefs[robot.name].known_q, command.q)
        elif isinstance(command, FollowPath) and isinstance(robot, Mobile):
            travel_s = robot.travel_s(command.nodes)
        else:
            return timing.effector_timeout_s
        return max(robot.timeout_s, travel_s * timing.deadline_factor + timing.deadline_floor_s)

    def _settles_at(self, command: Command, now: float) -> float | None:
        """When an effector that reports nothing counts as switched; None where it must report."""
        belief = self.beliefs[command.robot]
        evidence_level = belief.robot.evidence
        if not isinstance(command, SetEffector) or evidence_level is Evidence.IDS:
            return None
        if evidence_level is Evidence.JOINTS and belief.effector is not None:
            return None
        return now + self.model.timing.effector_settle_s

    def _book(self, entry: Entry, verdict: Verdict, now: float) -> None:
        """Feed the ledger; a motion that failed and may still be under way is halted."""
        before = entry.state
        self.ledger.feed(entry.command.id, verdict.feed, now, verdict.failure)
        self.version += entry.state is not before
        failed = entry.state is State.FAILED and verdict.feed is not Feed.REJECTED
        if failed and entry.is_motion and verdict.failure and verdict.failure.reason not in KNOWN_STILL:
            self._halt(entry.command.robot)

    def _went_stale(self, belief: Belief, now: float) -> None:
        belief.stale = True
        self.version += 1
        for entry in self.ledger.of_robot(belief.robot.name):
            silence = f"no telemetry for {belief.stale_after_s:g} s"
            sentence = f"{belief.robot.name}: {silence} while {entry.doing}"
            failure = Failure(reason=Reason.LINK_LOST, sentence=sentence)
            self._book(entry, Verdict(feed=Feed.FAILED, failure=failure), now)


def _overdue(entry: Entry) -> Verdict:
    if entry.settles_at is not None and entry.settles_at <= entry.deadline:
        return Verdict(feed=Feed.DONE)
    stopping = entry.state is State.CANCELLING
    what = "did not confirm that it stopped" if stopping else "did not finish"
    waited = entry.deadline - (entry.cancelled_at if entry.cancelled_at is not None else entry.sent_at)
    sentence = f"{entry.command.robot}: {what} within {waited:.1f} s while {entry.doing}"
    reason = Reason.STOP_UNCONFIRMED if stopping else Reason.DEADLINE
    return Verdict(feed=Feed.FAILED, failure=Failure(reason=reason, sentence=sentence))
