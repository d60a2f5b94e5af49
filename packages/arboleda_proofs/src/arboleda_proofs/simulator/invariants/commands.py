"""Commands: to whom they go, how often, how long they may take, and that what moves is halted."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from py_trees.behaviour import Behaviour

from arboleda.drivers import (
    Command,
    Evidence,
    Home,
    Motion,
    MotionState,
    MoveJoints,
    Query,
    Robot,
    Stop,
    StopMode,
    Switch,
)
from arboleda.engine import Act, State
from arboleda.engine.inspection import TABLE, teaching_of, time_of
from arboleda.kinds.joints.motion import JointMotion
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Reason, Verb
from arboleda.model.plant_model import Cell, Timing
from arboleda.recipes.of_files import ROUNDS, FileNode

from ..recorded.cells import KnownCell
from ..recorded.commands import Commands, SentCommand
from ..recorded.robots import Obstacle
from ..recorded.starts import most_turns
from .invariant import Look, Trigger, invariant

NOTHING: tuple[str, ...] = ()
ROUNDING_S = 1e-6
HOMING_S = 30.0
# Homing is what makes an unhomed robot homed; an operator may have the effector opened during a stop.
STOPPED = frozenset({Obstacle.LATCHED, Obstacle.STOPPED})
# A question moves nothing, so the device answers in spite of these.
ANSWERS_ALL_THE_SAME = STOPPED | {Obstacle.FAULTED, Obstacle.UNHOMED}
KNOWN_STILL = frozenset({Reason.STOPPED_SHORT, Reason.NOT_REACHED, Reason.STOPPED})
GIVEN_UP = frozenset({State.CANCELLING, State.CANCELLED, State.FAILED})
ON_AN_OPERATORS_WORD = "doing.own_verb"  # the key of what a command is for that no step has given


def _reachable() -> dict[State | None, frozenset[State]]:
    """The states that the ledger's rows lead to from each state, in one or more steps."""
    after: dict[State, set[State]] = {state: set() for state in State}
    for (before, _), then in TABLE.items():
        after[before].add(then)
    for _ in State:
        for reached in after.values():
            reached |= {far for near in reached for far in after[near]}
    return {None: frozenset(State), **{state: frozenset(reached) for state, reached in after.items()}}


REACHABLE = _reachable()


@invariant(Trigger.COMMANDED)
def no_command_to_unfit(look: Look) -> Iterable[str]:
    """Nothing but stops goes to a robot that is offline, unhomed, faulted or latched by what it has said."""
    for sent in look.record.commands.new:
        if sent.obstacles and (wrong := sent.obstacles - _excused(sent)):
            words = ", ".join(sorted(word.value for word in wrong))
            yield f"{sent} was sent, which is {words}"


def _excused(sent: SentCommand) -> frozenset[Obstacle]:
    command = sent.command
    if isinstance(command, Home):
        return frozenset({Obstacle.UNHOMED})
    if isinstance(command, Query):
        return ANSWERS_ALL_THE_SAME
    opens = isinstance(command, Switch) and command.grips is False
    return STOPPED if opens and Verb.RELEASE in sent.verbs else frozenset()


@invariant(Trigger.COMMANDED)
def stops_are_cleared_by_operators(look: Look) -> Iterable[str]:
    """A stop is cleared at a robot only when an operator has asked for that."""
    for sent in look.record.commands.new:
        command = sent.command
        clears = isinstance(command, Stop) and command.mode is StopMode.CLEAR
        if clears and Verb.CLEAR not in sent.verbs:
            yield f"{sent} clears its stop, which nobody asked for"


@invariant(Trigger.COMMANDED)
def one_motion_per_robot(look: Look) -> Iterable[str]:
    """At most one motion command, or other work, of a robot is open."""
    for sent in look.record.commands.new:
        if sent.is_work and (other := _open_before(sent, look.record.commands)):
            yield f"{sent} was sent while {other} was open"


def _open_before(sent: SentCommand, commands: Commands) -> SentCommand | None:
    """Another open motion of the robot that was not sent after this one in this step, if any."""
    later = commands.new[commands.new.index(sent) + 1 :]
    others = (each for each in commands.open.values() if each.robot == sent.robot and each.is_work)
    return next((each for each in others if each is not sent and each not in later), None)


@invariant(Trigger.NEWS)
def only_legal_command_states(look: Look) -> Iterable[str]:
    """A command changes its state only along the rows of the ledger's table, and leaves it only ended."""
    return _illegal(look)


def _illegal(look: Look) -> Iterator[str]:
    for sent, before in look.record.commands.moved:
        if sent.state not in REACHABLE[before]:
            then = sent.state.value if sent.state else "unknown"
            yield f"{sent} went from {before.value if before else 'nowhere'} to {then}"
    for sent in look.record.commands.lost:
        yield f"{sent} is no longer in the ledger, and has not ended"


@invariant(Trigger.NEWS)
def no_deadline_overrun(look: Look) -> Iterable[str]:
    """No command outlasts its deadline, no deadline its longest way, and no wait its end."""
    record = look.record
    return _late(look) if record.commands.soonest <= record.step.at else _overrun(look)


def _late(look: Look) -> Iterator[str]:
    for sent in look.record.commands.open.values():
        if sent.entry is not None and sent.entry.deadline <= look.record.step.at:
            yield f"{sent} is open past its deadline"


def _overrun(look: Look) -> Iterator[str]:
    record = look.record
    for sent in record.commands.new:
        if (too_long := _too_long(look, sent)) is not None:
            yield too_long
    for sent in record.commands.open.values():
        yield from _moved_deadline(look, sent)
    for cell in record.cells.values():
        if cell.looked:
            yield from _waits(cell.leaves, time_of(cell.run).now)


def _too_long(look: Look, sent: SentCommand) -> str | None:
    allowed_s = _longest_s(look.world.model.robots[sent.robot], sent, sent.timing)
    if sent.cancelled_at is not None:  # cancelled in the same step: its deadline is that of its halt
        allowed_s = max(allowed_s, sent.timing.stop_timeout_s)
    if sent.deadline <= sent.at + allowed_s + ROUNDING_S:
        return None
    return f"{sent} has {sent.deadline - sent.at:.1f} s; {allowed_s:.1f} s are enough for its longest way"


def _longest_s(robot: Robot, sent: SentCommand, timing: Timing) -> float:
    command = sent.command
    if command.at_most_s is not None:
        return command.at_most_s
    if isinstance(command, Switch):
        return timing.effector_timeout_s
    way_s = HOMING_S
    if isinstance(command, Motion) and command.way:
        way_s = robot.motion.travel_s(None, command.way) / robot.pace
    return max(robot.timeout_s, way_s * timing.deadline_factor + timing.deadline_floor_s)


def _moved_deadline(look: Look, sent: SentCommand) -> Iterator[str]:
    """Sentences on a deadline that was moved: a cancel gives another one, that for its halt, and a command
    that left late has at most so much more, to settle.
    """
    if sent.entry is None or sent.cancelled_at is None:
        moved_s = 0.0 if sent.entry is None else sent.entry.deadline - sent.deadline
        if moved_s and not 0 < moved_s <= sent.late_s + ROUNDING_S:
            yield f"the deadline of {sent} was moved"
    elif sent.entry.deadline > sent.cancelled_at + sent.timing.stop_timeout_s + ROUNDING_S:
        yield f"{sent} has more than stop_timeout_s to end after its cancel"


def _waits(leaves: Iterable[object], now: float) -> Iterator[str]:
    for leaf in leaves:
        until = getattr(leaf, "until", None) if not isinstance(leaf, Act) else leaf.again_at
        if until is not None and until <= now:
            yield f"{getattr(leaf, 'name', leaf)} still waits {now - until:.3f} s after its end"


@invariant(Trigger.COMMANDED)
def retries_bounded(look: Look) -> Iterable[str]:
    """A step gives its command once, once per retry, and once more each time that an operator says so; in a
    recipe that repeats it, in each turn.
    """
    for cell in look.record.cells.values():
        most = cell.cell.retry.times + 1 + cell.again
        for (leaf, _), count in cell.sends.items() if cell.looked else ():
            if count > most:
                yield f"{cell.name}: {leaf.name} gave its command {count} times, allowed are {most}"
        for leaf in cell.leaves if cell.looked else ():
            yield from _too_many_turns(cell, leaf)


def _too_many_turns(cell: KnownCell, leaf: Behaviour) -> Iterator[str]:
    """Sentences on a step that what repeats it has done more often than it says."""
    count = sum(count for (each, _), count in cell.sends.items() if each is leaf)
    most = most_turns(leaf) * (cell.cell.retry.times + 1) + cell.again
    if count > most:
        yield f"{cell.name}: {leaf.name} gave its command {count} times in all, allowed are {most:g}"
    node = leaf.parent
    while node is not None:
        if isinstance(node, FileNode) and ROUNDS in node.counts and node.rounds >= _rounds(node):
            yield f"{cell.name}: {node.name} has done its step {node.rounds} times, and does it again"
        node = node.parent


def _rounds(node: FileNode) -> float:
    """The number that a node of a file says of its rounds; without end where that is a variable, or -1."""
    text = node.ports.texts[node.port]
    return int(text) if text.isdecimal() else math.inf


@invariant(Trigger.NEWS)
def halted_moves_sent_halt(look: Look) -> Iterable[str]:
    """A motion that is given up, or whose step is left early, has had a halt or a stop sent after it."""
    return (*_given_up(look), *_left(look))


def _given_up(look: Look) -> Iterator[str]:
    for sent, _ in look.record.commands.moved:
        if sent.can_be_halted and sent.state in GIVEN_UP and not _needs_no_halt(look, sent):
            yield f"{sent} was given up, and no halt was sent"


def _left(look: Look) -> Iterator[str]:
    """Sentences on open commands for which no running step waits and that are not ending."""
    record = look.record
    for sent in record.commands.open.values():
        if not sent.can_be_halted or sent.state is State.CANCELLING or isinstance(sent.command, Home):
            continue
        if sent.entry is not None and sent.entry.doing.key == ON_AN_OPERATORS_WORD:
            continue
        cell = record.cells[sent.entry.cell] if sent.entry else None
        teaching = None if cell is None else teaching_of(cell.run)
        if cell is None or (teaching is not None and teaching.held is not None):
            continue  # of a cell that is taught whoever holds its button waits for it
        if cell.run.tree is None:
            yield f"{sent} is open, and no tree of {cell.name} runs"
        elif cell.looked and not any(getattr(leaf, "entry", None) is sent.entry for leaf in cell.leaves):
            yield f"{sent} is open, and no step of {cell.name} waits for it"


@invariant(Trigger.TOLD)
def held_cells_stand_still(look: Look) -> Iterator[str]:
    """A cell at work is held only once all that it had told to move has ended."""
    commands = look.record.commands
    changes = look.record.states.transitions
    held = {cell.name for cell, _, after in changes if after is CellState.HELD and cell.tree is not None}
    for sent in commands.open.values() if held else ():
        in_one = sent.entry is not None and sent.entry.cell in held
        if in_one and sent.can_be_halted and sent not in commands.new:
            yield f"{sent} is under way, and its cell is held"


def _needs_no_halt(look: Look, sent: SentCommand) -> bool:
    """True if a command has had its halt, or cannot be under way."""
    halted = look.record.robots[sent.robot].halts > sent.halts
    return halted or sent.rejected or _known_still(look, sent)


def _known_still(look: Look, sent: SentCommand) -> bool:
    """True if the robot itself has said in this step that it stands still."""
    failure = sent.entry.failure if sent.entry else None
    if failure is None or failure.reason not in KNOWN_STILL:
        return False
    codes = [report.state for report in look.moment.reports if report.robot == sent.robot]
    return any(code is not MotionState.MOVING for code in (*codes, look.record.robots[sent.robot].state))


@invariant(Trigger.TAKEN)
def no_move_after_its_halt(look: Look) -> Iterable[str]:
    """No move reaches the bridge after a stop or a halt that the plant gave after it: it would begin anew."""
    return look.record.early_stops.overtaken


@invariant(Trigger.COMMANDED)
def low_robots_rise_first(look: Look) -> Iterator[str]:
    """A robot whose last word places it at a target with an approach leaves it by that, or straight up,
    unless a person leads it by hand.
    """
    for sent in look.record.commands.new:
        if sent.way and sent.entry is not None:
            cell = look.world.plant.cells[sent.entry.cell]
            place = _low_place(look, sent.command, cell.cell)
            if place is not None and teaching_of(cell) is None:
                yield f"{sent} leaves {place} sideways"


def _low_place(look: Look, command: Command, cell: Cell) -> str | None:
    """The target with an approach that a move leaves neither by that approach nor straight up."""
    here, space = look.record.robots[command.robot].q, cell.reach.get(command.robot)
    if (
        not isinstance(command, MoveJoints)
        or here is None
        or space is None
        or space.robot.evidence is Evidence.STATE
    ):
        return None
    motion = space.robot.motion
    assert isinstance(motion, JointMotion)
    rows = zip(motion.joints, here, command.q, motion.tolerances, strict=True)
    if all(joint.lifts or abs(goal - at) <= 2 * within for joint, at, goal, within in rows):
        return None
    high = [(pose, pose.above) for pose in space.poses if pose.above is not None]
    if any(motion.stands_at(here, above) for _, above in high):
        return None  # within its tolerance it may be low, too
    if any(pose.above is None and motion.stands_at(here, pose.q) for pose in space.poses):
        return None  # the same spot, as a target without an approach
    low = {pose.name: above for pose, above in high if motion.stands_at(here, pose.q)}
    if any(motion.stands_at(command.q, above) for above in low.values()):
        return None
    return next(iter(low), None)


@invariant(Trigger.COMMANDED)
def tasks_take_their_time(look: Look) -> Iterator[str]:
    """A task commands nothing before `dwell_s` has passed since it was announced, and an arm of one that was
    nothing before as long has passed since its effector was told to grip or to let go, unless a recovery or
    an operator has begun.
    """
    for sent in look.record.commands.new:
        cell = look.record.cells[sent.entry.cell] if sent.entry is not None else None
        if cell is None or sent.verbs or cell.run.run.recovering or teaching_of(cell.run) is not None:
            continue
        since = _waits_since(look, cell, sent)
        if since is not None and sent.at < since + cell.timing.dwell_s - ROUNDING_S:
            yield f"{sent} leaves {sent.at - since:.3f} s after what it has to wait for"


def _waits_since(look: Look, cell: KnownCell, sent: SentCommand) -> float | None:
    """The time since which a command has to wait: of an effector that was switched, or of the task."""
    task = look.record.tasks.open.get(look.record.tasks.running.get(cell.name, ""))
    if task is None or task.announced is None:
        return None  # a tree of people, which has its own times
    before = sent.before
    if before is not None and before.entry is not None and before.entry.cell == cell.name:
        is_grip = isinstance(before.command, Switch) and before.command.grips is not None
        is_effector = look.world.model.robots[sent.robot].has_effector
        if is_grip and is_effector and before.state is State.DONE and not before.verbs:
            return before.at
    return task.announced


COMMANDS = (
    no_move_after_its_halt,
    no_command_to_unfit,
    stops_are_cleared_by_operators,
    one_motion_per_robot,
    only_legal_command_states,
    no_deadline_overrun,
    retries_bounded,
    halted_moves_sent_halt,
    held_cells_stand_still,
    low_robots_rise_first,
    tasks_take_their_time,
)
