"""Evidence about commands: what a report proves about an open command, by the robot's evidence level.

A rule looks at one open command, the belief before a report and the belief after it. It returns the feed that
the report proves, or None. A command ends by such proof: a message that says so may be of another command, of
another boot, or older than the command.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

from arboleda.model import refusals
from arboleda.model.commands import Command, Home, Motion, Position, Process, Query, Switch
from arboleda.model.facts import Facts, Value, shown
from arboleda.model.messages import Failure, MotionState, Reason, Report
from arboleda.model.plant_model import APART_S, QUIET_S, Evidence
from arboleda.model.sentence import Phrase, Sentence

from .belief import Belief
from .ledger import Entry, Feed, State

REFUSALS: dict[str, Reason] = {
    refusals.NO_LINK: Reason.LINK_LOST,
    refusals.LATE: Reason.LINK_LOST,
    refusals.STOPPED: Reason.STOPPED,
    refusals.NOT_HOMED: Reason.NOT_HOMED,
    refusals.CONDITION: Reason.PRECONDITION,
}
OBJECTIONS = frozenset({MotionState.FAULT, MotionState.NOT_HOMED, MotionState.STOP_LATCHED})
JITTER_S = APART_S  # two positions may arrive closer together by this than they were made

NO_TELEMETRY_FOR = Phrase(
    "command.no_telemetry_for", "{robot}: no telemetry for {seconds:.1f} s while {doing}"
)
LINK_LOST = Phrase("command.link_lost", "{robot}: the link was lost while {doing}")
LINK_LOST_BECAUSE = Phrase("command.link_lost_because", "{robot}: the link was lost while {doing}: {why}")
BRIDGE_RESTARTED = Phrase("command.bridge_restarted", "{robot}: the bridge restarted while {doing}")
REFUSED = Phrase("command.refused", "{robot}: refused the command for {doing} ({word})")
TOO_LATE = Phrase(
    "command.refused_late",
    "{robot}: the command for {doing} reached its board too late, which refused it ({word})",
)
BOARD_REBOOTED = Phrase("command.board_rebooted", "{robot}: the board rebooted while {doing}")
JOINTS_JUMPED = Phrase(
    "command.joints_jumped", "{robot}: the joints jumped, the board must have rebooted, while {doing}"
)
BOARD_FAULT = Phrase("command.board_fault", "{robot}: the board reports a fault while {doing}")
POSITION_UNKNOWN = Phrase(
    "command.position_unknown", "{robot}: the position is unknown, the robot is not homed, while {doing}"
)
STOPPED = Phrase("command.stopped", "{robot}: stopped and latched while {doing}")
OFF_TARGET = Phrase(
    "command.off_target", "{robot}: reported the move done but stands off its target while {doing}"
)
FACT_UNSAID = Phrase(
    "command.fact_unsaid",
    "{robot}: reported the work done but does not say its {fact} while {doing}",
)
FACT_OTHER = Phrase(
    "command.fact_other",
    "{robot}: reported the work done but says {value} of its {fact} while {doing}",
)
GAVE_UP = Phrase("command.gave_up", "{robot}: gave up ({word}) while {doing}")
SHORT_OF_TARGET = Phrase("command.short_of_target", "{robot}: stopped before its target while {doing}")


@dataclass(frozen=True, kw_only=True)
class CommandVerdict:
    """Verdict on a command: a feed for the ledger, the cause of a failure, the answer to a query."""

    feed: Feed
    failure: Failure | None = None
    answer: Value | None = None


class Before(NamedTuple):
    """Belief just before the report under judgement."""

    epoch: int | None
    boot_id: int | None
    position: Position | None
    position_at: float
    online: bool

    @classmethod
    def of(cls, belief: Belief) -> Before:
        return cls(belief.epoch, belief.boot_id, belief.position, belief.stillness.position_at, belief.online)


def judge(entry: Entry, before: Before | None, belief: Belief, report: Report) -> CommandVerdict | None:
    """The strongest feed that `report` proves about `entry`; None where it proves nothing new.

    `before` is None for a report that repeats the last one: it shows no broken link and no reboot.
    """
    broken = _refused(entry, report) if before is None else _broken(entry, before, belief, report)
    if broken is not None or report.at < entry.sent_at:
        return broken
    _look(entry, belief, report)
    objection = _device(entry, belief, report) if report.state in OBJECTIONS else None
    verdict = objection or _progress(entry, belief, report)
    if verdict is None and entry.cancelled_at is not None and entry.halts:
        return _stopping(entry, belief)
    return verdict


def _look(entry: Entry, belief: Belief, report: Report) -> None:
    observed = entry.observations
    _look_at_goal(entry, belief, report)
    observed.moving = observed.moving or report.state is MotionState.MOVING
    if report.state is not None:
        observed.stopped_since = (observed.stopped_since or report.at) if _rests(entry, report) else None
    if report.done not in (None, observed.ended, entry.command.id):
        observed.unhomed = False  # the end of an earlier command comes only now: "unhomed" was of that
    observed.unhomed = observed.unhomed or report.homed is False
    observed.ended = report.done or observed.ended


def _rests(entry: Entry, report: Report) -> bool:
    """True where a robot reports rest; latched counts for work that goes on to its end when it is stopped."""
    finished = entry.finishes and report.state is MotionState.STOP_LATCHED
    return finished or report.state is MotionState.STOPPED


def _look_at_goal(entry: Entry, belief: Belief, report: Report) -> None:
    """Note since when every report shows the goal, and how far along its positions the robot was seen.

    A path that passes its goal earlier has to show all positions before.
    """
    observed, place = entry.observations, belief.position_in(report)
    if place is None and not _tells(report, entry.sets):
        return
    if place is not None and len(entry.positions) > 1 and place != observed.place:
        observed.place = place
        ahead = entry.positions[observed.passed + 1 :]
        observed.passed += ahead.index(place) + 1 if place in ahead else 0
    driven = len(entry.positions) <= 1 or observed.passed == len(entry.positions) - 1
    at_end = driven and reached(entry, belief)
    observed.on_goal_since = (observed.on_goal_since or report.at) if at_end else None


def _tells(report: Report, facts: Facts) -> bool:
    return any(report.fact(name) is not None for name, _ in facts)


def reached(entry: Entry, belief: Belief) -> bool:
    """True where the belief shows the goal of a command: its last position, and the facts that it sets."""
    for name, value in entry.sets:
        if belief.fact(name) != value:
            return False
    if not entry.positions:
        return entry.sets != ()
    return belief.position is not None and belief.robot.motion.stands_at(belief.position, entry.positions[-1])


def _failed(entry: Entry, reason: Reason, what: Phrase, **values: str | float | Sentence) -> CommandVerdict:
    return CommandVerdict(feed=Feed.FAILED, failure=_failure(entry, reason, what, **values))


def _failure(entry: Entry, reason: Reason, what: Phrase, **values: str | float | Sentence) -> Failure:
    sentence = what(robot=entry.command.robot, doing=entry.doing, **values)
    return Failure(reason=reason, sentence=sentence)


def _broken(entry: Entry, before: Before, belief: Belief, report: Report) -> CommandVerdict | None:
    """The failure that a report shows; most show none, so that no rule is asked that cannot apply."""
    verdict = None
    if report.state is MotionState.NO_LINK or report.epoch != before.epoch:
        verdict = _broken_link(entry, before, belief, report)
    if verdict is None and report.rejected is not None:
        verdict = _refused(entry, report)
    if verdict is None and report.failed is not None:
        verdict = _gave_up(entry, report)
    if verdict is None and (report.boot_id != before.boot_id or belief.robot.evidence is Evidence.JOINTS):
        verdict = _reboot(entry, before, belief, report)
    return verdict


def _broken_link(entry: Entry, before: Before, belief: Belief, report: Report) -> CommandVerdict | None:
    if report.state is MotionState.NO_LINK:
        if report.lost is not None:
            return _failed(entry, Reason.LINK_LOST, LINK_LOST_BECAUSE, why=report.lost)
        silence_s = 0.0 if belief.heard_at is None else report.at - belief.heard_at
        silent = silence_s >= belief.stale_after_s
        if silent:
            return _failed(entry, Reason.LINK_LOST, NO_TELEMETRY_FOR, seconds=silence_s)
        return _failed(entry, Reason.LINK_LOST, LINK_LOST)
    if before.epoch is not None and report.epoch is not None and report.epoch != before.epoch:
        return _failed(entry, Reason.LINK_LOST, BRIDGE_RESTARTED)
    return None


def _refused(entry: Entry, report: Report) -> CommandVerdict | None:
    if report.rejected != entry.command.id:
        return None
    word = report.refusal or "no reason given"
    what, reason = TOO_LATE if word == refusals.LATE else REFUSED, REFUSALS.get(word, Reason.REJECTED)
    return CommandVerdict(feed=Feed.REJECTED, failure=_failure(entry, reason, what, word=word))


def _gave_up(entry: Entry, report: Report) -> CommandVerdict | None:
    if report.failed != entry.command.id:
        return None
    return _failed(entry, Reason.DEVICE_FAULT, GAVE_UP, word=report.failure or "no reason given")


def _reboot(entry: Entry, before: Before, belief: Belief, report: Report) -> CommandVerdict | None:
    if rebooted(before, belief, report):
        return _failed(entry, Reason.REBOOTED, BOARD_REBOOTED)
    if belief.robot.evidence is Evidence.JOINTS and _jumped(before, belief, report):
        return _failed(entry, Reason.REBOOTED, JOINTS_JUMPED)
    return None


def displaced(before: Before, belief: Belief, report: Report) -> bool:
    """True where a robot that cannot report it must have lost its position: a new boot, or a jump."""
    jumped = belief.robot.evidence is Evidence.JOINTS and _jumped(before, belief, report)
    return jumped or rebooted(before, belief, report)


def strayed(belief: Belief, report: Report, goal: Position) -> bool:
    """True where a robot that had reached `goal` is elsewhere after a silence: it may have booted unseen."""
    robot, place = belief.robot, belief.position_in(report)
    if place is None or robot.evidence is not Evidence.JOINTS or robot.reference is None:
        return False
    return not robot.motion.stands_at(place, goal)


def came_back_at_zero(before: Before, belief: Belief, report: Report, stood: Position | None) -> bool:
    """True where a robot is at its reference after a silence, and did not surely stand there before.

    A board that takes itself for homed counts from there after a boot, wherever its robot is then.
    """
    robot, place = belief.robot, belief.position_in(report)
    if before.position is None or place is None or robot.reference is None:
        return False
    if robot.evidence is not Evidence.JOINTS or not robot.assume_homed:
        return False
    at_reference = partial(robot.motion.stands_at, robot.reference)
    stood_there = stood is not None and at_reference(stood) and at_reference(before.position)
    return at_reference(place) and not stood_there


def rebooted(before: Before, belief: Belief, report: Report) -> bool:
    """True where the boot id changed; at `joints` the bridge counts boots, and counts anew when it starts."""
    if before.boot_id == report.boot_id or None in (before.boot_id, report.boot_id):
        return False
    evidence = belief.robot.evidence
    return evidence is Evidence.IDS or (evidence is Evidence.JOINTS and before.epoch == report.epoch)


def _jumped(before: Before, belief: Belief, report: Report) -> bool:
    """True where the robot moved further between two reports than its limits allow."""
    place = belief.position_in(report)
    if before.position is None or place is None:
        return False
    elapsed_s = report.at - before.position_at + JITTER_S
    return not belief.robot.motion.can_have_moved(before.position, place, elapsed_s)


def _device(entry: Entry, belief: Belief, report: Report) -> CommandVerdict | None:
    """The objection of a device that reports one of OBJECTIONS."""
    if report.state is MotionState.FAULT:
        if isinstance(entry.command, Home) and belief.is_cleared_by_homing:
            return None  # homing leads it out of that fault; its driver reports where it cannot
        return _failed(entry, Reason.DEVICE_FAULT, BOARD_FAULT)
    if not entry.is_work:
        return None
    if report.state is MotionState.NOT_HOMED and not isinstance(entry.command, Home):
        return _failed(entry, Reason.NOT_HOMED, POSITION_UNKNOWN)
    stopping = entry.state is State.CANCELLING or entry.finishes
    if report.state is MotionState.STOP_LATCHED and not stopping:
        return CommandVerdict(feed=Feed.HALTED, failure=_failure(entry, Reason.STOPPED, STOPPED))
    return None


def _stopping(entry: Entry, belief: Belief) -> CommandVerdict | None:
    """The end of a command that was cancelled, and can be halted."""
    return CommandVerdict(feed=Feed.HALTED) if belief.stillness.still_since(entry.cancelled_after) else None


def _progress(entry: Entry, belief: Belief, report: Report) -> CommandVerdict | None:
    if entry.rule is None:
        entry.rule = rule_for(type(entry.command), belief.robot.evidence)
    verdict: CommandVerdict | None = entry.rule(entry, belief, report)
    if verdict is not None and verdict.feed is Feed.FAILED and entry.cancelled_at is not None:
        return None  # it was cancelled, so it stops short of its goal
    return verdict


def _work_by_ids(entry: Entry, belief: Belief, report: Report) -> CommandVerdict | None:
    finished = report.done == entry.command.id
    if finished and _rests(entry, report):
        return _off_target(entry, belief) if _elsewhere(entry, belief) else CommandVerdict(feed=Feed.DONE)
    if entry.accepted_at is None:
        return CommandVerdict(feed=Feed.ACCEPTED) if finished or report.accepted == entry.command.id else None
    if _rests(entry, report) and _elsewhere(entry, belief):
        return _short(entry)
    return None


def _elsewhere(entry: Entry, belief: Belief) -> bool:
    """True where a command has a goal, and the robot is not there."""
    return (entry.positions != () or entry.sets != ()) and not reached(entry, belief)


def _move_by_joints(entry: Entry, belief: Belief, report: Report) -> CommandVerdict | None:
    """Judge a move by a state and a position that are of two instants, and may come in any order.

    An old "stopped" may meet a new position, and a new command may meet the end of the move before it. So a
    move is done where the robot is on its goal and was seen to move and to stop, or has not said "moving" for
    QUIET_S. It stopped short where the robot has left its origin, and stands elsewhere for QUIET_S.
    """
    observed = entry.observations
    if belief.state is MotionState.STOPPED:
        if observed.on_goal_since is not None:
            if _stays_on_goal(entry, belief, report.at, since=observed.on_goal_since):
                return CommandVerdict(feed=Feed.DONE)
        elif _stays_short(entry, belief, report.at):
            return _short(entry)
    return CommandVerdict(feed=Feed.ACCEPTED) if observed.moving and entry.state is State.SENT else None


def _stays_on_goal(entry: Entry, belief: Belief, at: float, *, since: float) -> bool:
    """True where a robot that says stopped, and is on its goal `since`, has come to rest there.

    A robot of a grid that was one node off when it left comes by its goal and goes on to the next node. So of
    such a robot a node counts only if it is told `APART_S` after the stop: it cannot be from before the stop.
    """
    observed = entry.observations
    if not observed.moving:
        return at >= since + QUIET_S
    if observed.stopped_since is None:
        return False
    return len(entry.positions) <= 1 or belief.stillness.position_at >= observed.stopped_since + APART_S


def _stays_short(entry: Entry, belief: Belief, at: float) -> bool:
    observed = entry.observations
    if not observed.moving or observed.stopped_since is None or at < observed.stopped_since + QUIET_S:
        return False
    if not entry.positions:
        return True
    if belief.position == entry.origin:
        return False  # a robot that never left may have told the end of an earlier move
    return belief.stillness.rested_since(observed.stopped_since + APART_S)


def _process_by_facts(entry: Entry, belief: Belief, report: Report) -> CommandVerdict | None:
    """Judge a process by facts. These may be older than the process, so it has to be seen at work before."""
    observed = entry.observations
    if observed.moving and observed.stopped_since is not None:
        if not entry.sets or observed.on_goal_since is not None:
            return CommandVerdict(feed=Feed.DONE)
        if _stays_short(entry, belief, report.at):
            return _short(entry)
    return CommandVerdict(feed=Feed.ACCEPTED) if observed.moving and entry.state is State.SENT else None


def _work_by_state(entry: Entry, belief: Belief, report: Report) -> CommandVerdict | None:
    if entry.observations.moving and _rests(entry, report) and entry.cancelled_at is None:
        return CommandVerdict(feed=Feed.DONE)  # after a halt, this code would prove the halt alone
    return (
        CommandVerdict(feed=Feed.ACCEPTED)
        if entry.observations.moving and entry.state is State.SENT
        else None
    )


def _unproven(entry: Entry, belief: Belief, report: Report) -> CommandVerdict | None:
    """No report proves such a command: it settles, or fails by its deadline."""
    return None


def _set_as_reported(entry: Entry, belief: Belief, report: Report) -> CommandVerdict | None:
    """Judge a switch by the facts that it sets, since a UInt8 command of ROS 2 carries no id."""
    if not entry.sets:
        return CommandVerdict(feed=Feed.DONE) if report.done == entry.command.id else None
    if entry.must_be_named and report.number is not None:
        entry.must_be_named = entry.command.id not in (report.accepted, report.done)
        if entry.must_be_named:
            return None
    for name, value in entry.sets:
        if report.fact(name) != value:
            return None
    return CommandVerdict(feed=Feed.DONE)


def _answered(entry: Entry, belief: Belief, report: Report) -> CommandVerdict | None:
    """Judge a query by an answer that names it: any other may be to an earlier question."""
    if report.answered == entry.command.id and report.answer is not None:
        return CommandVerdict(feed=Feed.DONE, answer=report.answer)
    taken = report.accepted == entry.command.id and entry.state is State.SENT
    return CommandVerdict(feed=Feed.ACCEPTED) if taken else None


def _homed_by_ids(entry: Entry, belief: Belief, report: Report) -> CommandVerdict | None:
    """Judge a homing by `homed`: first False, then True while the robot stands."""
    if entry.observations.unhomed and report.homed and report.state is MotionState.STOPPED:
        return CommandVerdict(feed=Feed.DONE)
    return (
        CommandVerdict(feed=Feed.ACCEPTED)
        if entry.observations.unhomed and entry.state is State.SENT
        else None
    )


def _off_target(entry: Entry, belief: Belief) -> CommandVerdict:
    name = next((name for name, value in entry.sets if belief.fact(name) != value), None)
    if name is None:
        return _failed(entry, Reason.NOT_REACHED, OFF_TARGET)
    reported = belief.fact(name)
    if reported is None:
        return _failed(entry, Reason.NOT_REACHED, FACT_UNSAID, fact=name)
    return _failed(entry, Reason.NOT_REACHED, FACT_OTHER, fact=name, value=shown(reported))


def _short(entry: Entry) -> CommandVerdict:
    return _failed(entry, Reason.STOPPED_SHORT, SHORT_OF_TARGET)


Rule = Callable[[Entry, Belief, Report], "CommandVerdict | None"]
RULES: dict[tuple[type[Command], Evidence], Rule] = {
    (Motion, Evidence.IDS): _work_by_ids,
    (Motion, Evidence.JOINTS): _move_by_joints,
    (Motion, Evidence.STATE): _work_by_state,
    (Home, Evidence.IDS): _homed_by_ids,
    (Home, Evidence.JOINTS): _unproven,
    (Home, Evidence.STATE): _unproven,
    (Process, Evidence.IDS): _work_by_ids,
    (Process, Evidence.JOINTS): _process_by_facts,
    (Process, Evidence.STATE): _work_by_state,
    (Switch, Evidence.IDS): _set_as_reported,
    (Switch, Evidence.JOINTS): _set_as_reported,
    (Query, Evidence.IDS): _answered,
    (Query, Evidence.JOINTS): _answered,
    (Query, Evidence.STATE): _answered,
    (Command, Evidence.IDS): _unproven,
    (Command, Evidence.JOINTS): _unproven,
    (Command, Evidence.STATE): _unproven,
}
"""The rule that proves a command, by its class and by the evidence level of its robot."""


def rule_for(kind: type[Command], level: Evidence) -> Rule:
    """The rule for a class of commands: its own, or that of its nearest base."""
    return next(RULES[base, level] for base in kind.__mro__ if (base, level) in RULES)
