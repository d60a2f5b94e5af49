"""Proofs: what the reports of one step prove of each open command, by rules written down here once more.

The rules are slower and plainer than the plant's, and none of its books is read.

`proofs_end_commands` finds by it a device fault that fails only motions.
"""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass, field, replace
from typing import cast

from arboleda.drivers import (
    Evidence,
    FollowPath,
    Home,
    Jointed,
    Motion,
    MotionState,
    MoveJoints,
    Query,
    Report,
    Robot,
    Switch,
)
from arboleda.model.messages import Failure, Reason

from .commands import SentCommand
from .robots import KnownRobot

FLOAT_SLACK = 1e-9
REFUSED = {
    "no_link": Reason.LINK_LOST,
    "tarde": Reason.LINK_LOST,
    "paro": Reason.STOPPED,
    "sin_ref": Reason.NOT_HOMED,
    "condicion": Reason.PRECONDITION,
}


@dataclass
class Proof:
    """Proof for one command from its robot's reports of this step, in their order.

    `causes` are reasons for which it may fail now; `must_end` says why it must end; `must_run`: its board has
    named it, so it must count as accepted; `done`, `named`, `still`: it may be done, under way, or halted.
    """

    causes: set[Reason] = field(default_factory=set)
    must_end: str = ""
    must_run: bool = False
    done: bool = False
    named: bool = False
    still: bool = False


@dataclass
class ReportEvidence:
    """All that reports have shown of a command since it was sent."""

    moving: bool = False
    position: bool = False
    facts: bool = False  # one of those that it sets
    unhomed: bool = False


NOTHING: tuple[Proof | None, float | None] = (None, None)


class Proofs:
    """Proofs by command id in `of`, for this step; a command of which nothing was said has none.

    `by_robot` are the open commands: the reports of other robots prove nothing.
    """

    def __init__(self) -> None:
        self.of: defaultdict[str, Proof] = defaultdict(Proof)
        self._shown: defaultdict[str, ReportEvidence] = defaultdict(ReportEvidence)
        # of reports that only said the last one again: what each such one proves, and when it was cancelled
        self._repeated: dict[str, tuple[Proof, float | None]] = {}
        self.by_robot: dict[str, list[SentCommand]] = {}

    def forget(self) -> None:
        """Forget all, as the plant that sent the commands is gone."""
        self.of.clear()
        self._shown.clear()
        self._repeated.clear()
        self.by_robot.clear()

    def follow(self, sent: list[SentCommand]) -> None:
        """Take over which commands are open after this step."""
        self.by_robot.clear()
        for each in sent:
            self.by_robot.setdefault(each.robot, []).append(each)
        ids = {each.command.id for each in sent}
        for id in self._shown.keys() - ids:
            del self._shown[id]
        for id in self._repeated.keys() - ids:
            del self._repeated[id]

    def hear(self, report: Report, known: KnownRobot) -> None:
        """Take in a report; `known` is what its robot had said before."""
        repeats = report.words == known.words and report.at <= known.stale_at
        for sent in self.by_robot.get(report.robot, ()):
            id = sent.command.id
            proof, (again, cancelled_at) = self.of.get(id), self._repeated.get(id, NOTHING)
            if proof is not None and proof is again:
                proof = self.of[id] = replace(proof, causes=set(proof.causes))  # it stays as it is
            elif proof is None and again is not None and repeats and cancelled_at == sent.cancelled_at:
                self.of[id] = again
                continue
            alone = proof is None
            proof = self.of[id]
            _broken(proof, sent, report, known)
            if report.at >= sent.at:
                self._take_in(proof, sent, report, known)
            if alone and repeats and report.at >= sent.at:
                self._repeated[id] = proof, sent.cancelled_at
            elif not repeats:
                self._repeated.pop(id, None)

    def _take_in(self, proof: Proof, sent: SentCommand, report: Report, known: KnownRobot) -> None:
        """Take in a report that is not older than the command."""
        q = known.q if report.q is None else report.q
        node = known.node if report.node is None else report.node
        shown = self._shown[sent.command.id]
        _see(shown, sent, report)
        _note_state(proof, sent, report)
        off = _off(sent, known.robot, q, node) if sent.way else _off_facts(sent, report, known)
        _moved(proof, sent, shown, report, known.robot, off)


def _broken(proof: Proof, sent: SentCommand, report: Report, known: KnownRobot) -> None:
    """Note what ends any command: a lost link, silence, a restarted bridge, a boot."""
    if report.state is MotionState.NO_LINK:
        _must(proof, Reason.LINK_LOST, "its link was lost")
    if report.at > known.stale_at:
        _must(proof, Reason.LINK_LOST, "its robot was silent for too long")
    if known.epoch is not None and report.epoch is not None and report.epoch != known.epoch:
        _must(proof, Reason.LINK_LOST, "its bridge was restarted")
    if report.boot_id != known.boot and _booted(report, known):
        _must(proof, Reason.REBOOTED, "its board booted")
    if known.robot.evidence is Evidence.JOINTS:
        proof.causes.add(Reason.REBOOTED)  # its place may have jumped; how far is judged elsewhere
    if report.rejected == sent.command.id:
        _must(proof, REFUSED.get(report.refusal or "", Reason.REJECTED), "it was refused")
    if report.failed == sent.command.id:
        _must(proof, Reason.DEVICE_FAULT, "its device gave it up")


def _booted(report: Report, known: KnownRobot) -> bool:
    """True if the board has booted; counts of boots at `joints` are comparable for one bridge only."""
    if None in (report.boot_id, known.boot):
        return False
    same_bridge = report.epoch == known.epoch
    evidence = known.robot.evidence
    return evidence is Evidence.IDS or (evidence is Evidence.JOINTS and same_bridge)


def _must(proof: Proof, reason: Reason, why: str) -> None:
    proof.causes.add(reason)
    proof.must_end = proof.must_end or why


def _see(shown: ReportEvidence, sent: SentCommand, report: Report) -> None:
    shown.moving |= report.state is MotionState.MOVING
    shown.position |= report.q is not None or report.node is not None
    for name, _ in sent.sets:
        shown.facts |= report.fact(name) is not None
    shown.unhomed |= report.homed is False


def _note_state(proof: Proof, sent: SentCommand, report: Report) -> None:
    """Note what state codes prove by themselves."""
    if report.state is MotionState.FAULT:
        _must(proof, Reason.DEVICE_FAULT, "its board reports a fault")
    if not sent.is_work:
        return
    if report.state is MotionState.NOT_HOMED and not isinstance(sent.command, Home):
        _must(proof, Reason.NOT_HOMED, "its robot is not homed")
    if report.state is MotionState.STOP_LATCHED:
        proof.causes.add(Reason.STOPPED)
    proof.still |= report.state in (MotionState.STOPPED, MotionState.STOP_LATCHED, MotionState.NOT_HOMED)
    proof.still |= report.state in (MotionState.FAULT, None)  # a position alone may be what was missing


def _moved(
    proof: Proof, sent: SentCommand, shown: ReportEvidence, report: Report, robot: Robot, off: float | None
) -> None:
    """Note that it is under way or done; `off` is how far beyond its tolerance the robot stands."""
    command, stopped = sent.command, _rests(sent, report)
    if isinstance(command, Switch):
        holds = all(report.fact(name) == value for name, value in sent.sets)
        proof.done |= holds if sent.sets else report.done == command.id
        return
    if isinstance(command, Query):
        proof.named |= report.accepted == command.id
        proof.done |= report.answered == command.id and report.answer is not None
        return
    if isinstance(command, Home):
        proof.named |= shown.unhomed
        proof.done |= shown.unhomed and bool(report.homed) and stopped
        return
    if robot.evidence is Evidence.IDS:
        ended = report.done == command.id
        proof.named |= ended or report.accepted == command.id
        proof.must_run |= report.accepted == command.id
        proof.done |= ended and stopped and _at(off)
        if ended and stopped and not _surely_at(off):
            proof.causes.add(Reason.NOT_REACHED)
        if ended and stopped and off is not None and (_surely_at(off) or sent.cancelled_at is None):
            proof.must_end = proof.must_end or "its board says that it is done"
    else:
        proof.named |= shown.moving
        # at `joints` state and place come in separate messages, so the truth judges the distance
        goal = shown.position or shown.facts
        by_goal = robot.evidence is Evidence.JOINTS and isinstance(command, Motion)
        # the facts that a process sets may be older than it
        has_moved = goal if by_goal and (sent.way or sent.sets) else shown.moving
        proof.done |= has_moved and (stopped or report.state is None)
    if (stopped or report.state is None) and not _surely_at(off):
        proof.causes.add(Reason.STOPPED_SHORT)


def _rests(sent: SentCommand, report: Report) -> bool:
    """True if the robot is at rest; "stopped" also ends work that goes on through a stop."""
    latched = sent.finishes and report.state is MotionState.STOP_LATCHED
    return latched or report.state is MotionState.STOPPED


def _at(off: float | None) -> bool:
    return off is not None and off <= FLOAT_SLACK


def _surely_at(off: float | None) -> bool:
    return off is not None and off < -FLOAT_SLACK


def _off(sent: SentCommand, robot: Robot, q: tuple[float, ...] | None, node: int | None) -> float | None:
    """The distance beyond its goal's tolerance of the worst joint; for a path see `_off_path`."""
    command = sent.command
    if isinstance(command, FollowPath):
        return None if node is None else _off_path(command.nodes, node)
    if not isinstance(command, MoveJoints) or not robot.joints or q is None:
        return None
    beyond, tolerances = -math.inf, cast(Jointed, robot).tolerance
    for number, (at, goal, joint) in enumerate(zip(q, command.q, robot.joints, strict=True)):
        tolerance = tolerances[number] if tolerances else joint.step / 2 + 1e-5
        steps = math.floor(abs(goal) / joint.step + 0.5) * (1 if goal >= 0 else -1)
        beyond = max(beyond, abs(at - steps * joint.step) - tolerance)
    return beyond


def _off_facts(sent: SentCommand, report: Report, known: KnownRobot) -> float:
    """The distance from a switch's goal: -1 if all facts that it sets are so by their last report, else 1."""
    reported = {name: report.fact(name) for name, _ in sent.sets}
    latest = {name: known.fact(name) if value is None else value for name, value in reported.items()}
    return -1.0 if all(latest[name] == value for name, value in sent.sets) else 1.0


def _off_path(nodes: tuple[int, ...], node: int) -> float:
    """The distance from a path's end: 1 away, -1 there, 0 there if the path comes by before, too."""
    if node != nodes[-1]:
        return 1.0
    return 0.0 if node in nodes[:-1] else -1.0


def cause_text(failure: Failure | None) -> str:
    return f"{failure.reason.value} ({failure.sentence})" if failure else "no cause"
