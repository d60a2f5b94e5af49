"""Invariants of devices, by their true facts, whatever kinds of device they are."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.dispatch.ledger import State
from arboleda.model.commands import Motion, Query
from arboleda.model.plant_model import Evidence, MotionState, Robot

from ..truth.ended_commands import EndedCommand
from ..truth.robot import RobotTruth
from ..truth.truth import Truth
from .invariant import Look, Trigger, invariant


@invariant(Trigger.BOOKED)
def what_is_done_was_so(look: Look) -> Iterator[str]:
    """A command that counts as done was done since it was given: its facts were so, its goal was reached;
    where its board lies about that, nobody could know.
    """
    truth = look.truth
    for booked in truth.books.ended:
        command, robot = booked.command, truth.robot(booked.command.robot)
        if not booked.done or robot is None or _unprovable(truth, booked, robot):
            continue
        what = f"{type(command).__name__} {command.id}"
        for name, value in command.sets:
            if not truth.was_so(command.robot, name, value, booked.sent_at):
                yield f"{command.robot}: {name} was never {value} since {what}"
        goes = isinstance(command, Motion) and command.way
        if goes and not truth.stood_at(command.robot, command, booked.sent_at):
            yield f"{command.robot} never stood at the goal of {what}"


def _unprovable(truth: Truth, booked: EndedCommand, robot: RobotTruth) -> bool:
    """True if a robot's reports prove nothing of a command, by its evidence or by lies.

    At `ids` work shows in two ways, its number and what it sets, and both must be lies; a switch shows in
    what it sets alone.
    """

    def lies(what: str) -> bool:
        return truth.deceived_since(robot.robot.mqtt, what, booked.sent_at)

    if robot.blind or robot.put_right_at >= booked.sent_at:
        return True
    if not booked.entry.is_work and not _tells_switches(robot.robot):
        return True
    if robot.robot.evidence is Evidence.IDS and booked.entry.is_work:
        return lies("done") and lies(robot.PLACE)
    return booked.late or lies(robot.PLACE) or lies("effector") or lies("state")


def _tells_switches(robot: Robot) -> bool:
    """False for an arm whose effector counts as switched after a time, as nobody reports anything of it."""
    return robot.evidence is Evidence.IDS or not robot.has_effector


@invariant(Trigger.DONE_TASKS)
def what_a_task_left_is_so(look: Look) -> Iterator[str]:
    """A task that is called done leaves each of its devices as the last command to that has set it, unless
    power, somebody's hand, a lie or another cell that shares it has changed that; an effector of which nobody
    reports anything counts as switched after a time.
    """
    truth, last_sent = look.truth, look.world.plant.dispatcher.last_sent
    for cell, task, began in truth.done_tasks:
        of_task = look.world.model.cell(cell)
        for robot in of_task.robots:
            booked = truth.last_done(robot.name)
            if booked is None or booked.sent_at < began:
                continue
            if not _tells_switches(robot):
                continue
            last = last_sent.get(robot.name)
            if robot.name in of_task.shared and last is not None and last.sent_at > booked.sent_at:
                continue
            for name, value in booked.command.sets:
                body = truth.robot(robot.name)
                since = max(body.booted_us / 1e6, body.put_right_at)
                lies = any(truth.deceived_since(robot.mqtt, what, began) for what in (body.PLACE, "effector"))
                if body.body.true_facts.get(name) != value and since < booked.sent_at and not lies:
                    yield f"{task} is called done, and {name} of {robot.name} is not {value}"


@invariant(Trigger.CHANGED)
def needs_hold(look: Look) -> Iterator[str]:
    """The needs of a verb are met when it begins, and for as long as it is work that goes on."""
    for robot in look.truth.changed:
        for command, why in robot.unmet:
            yield f"{robot.robot.name} carries out {command.given}: {why}"


@invariant(Trigger.COMMANDED)
def no_command_against_a_need(look: Look) -> Iterator[str]:
    """No command leaves whose device has said last that what it needs is not so, or that it is at work that
    needs the contrary of what the command sets.
    """
    for sent in look.record.commands.new:
        known, sets = look.record.robots[sent.robot], dict(sent.command.sets)
        for name, value in sent.command.needs:
            if known.fact(name) != value:
                yield f"{sent} leaves, needs {name} {value}, and {sent.robot} said {known.fact(name)}"
        work = look.record.commands.last_work.get(sent.robot)
        if work is None or work is sent or work.state is State.DONE or known.state is not MotionState.MOVING:
            continue
        for name, value in work.command.needs:
            if sets.get(name, value) != value:
                yield f"{sent} leaves, and {sent.robot} said that it is at {work}, which needs {name} {value}"


@invariant(Trigger.CHANGED)
def finishing_work_is_finished(look: Look) -> Iterator[str]:
    """Work that goes on through a stop ends in its own time, unless power, an alarm or an order ends it."""
    for robot in look.truth.changed:
        if robot.cut_short:
            yield f"{robot.robot.name} was cut short in what it was to finish"


@invariant(Trigger.CHANGED)
def nothing_is_dropped(look: Look) -> Iterator[str]:
    """A robot lets go of what it carries only where it stands at a target, or on an operator's word; where
    its tool has said too early that it had let go, nobody could know.
    """
    truth = look.truth
    for cell in look.world.model.cells:
        for space in cell.spaces:
            hand, carrier = truth.robot(space.hand.name), truth.robot(space.robot.name)
            if hand not in truth.changed or carrier is None or not hand.let_go:
                continue
            places = carrier.here | carrier.stood if carrier in truth.changed else carrier.here
            excused = carrier.taken_away or truth.released(space.hand.name) or truth.mistaken(carrier)
            if not places and not excused and not _is_said_too_early(truth, hand):
                yield f"{space.hand.name} lets go, and {space.robot.name} stands at no target"


def _is_said_too_early(truth: Truth, hand: RobotTruth) -> bool:
    """True if the last command of a tool is called done because of a lie about what it holds."""
    booked = truth.last_done(hand.robot.name)
    return booked is not None and truth.deceived_since(hand.robot.mqtt, hand.PLACE, booked.sent_at)


@invariant(Trigger.BOOKED)
def an_answer_is_to_its_question(look: Look) -> Iterator[str]:
    """The answer that counts for a question is one that its device has given to this very question."""
    truth = look.truth
    for booked in truth.books.ended:
        if not booked.done or not isinstance(booked.command, Query):
            continue
        board = look.world.model.robots[booked.command.robot].mqtt
        told = booked.entry.answer
        if told not in truth.answers(booked.command.id) and not truth.deceived_since(
            board, "answer", booked.sent_at
        ):
            yield f"{booked.command.robot} has not answered {told!r} to {booked.command.id}"


@invariant(Trigger.BRIDGED)
def commands_of_others_are_told(look: Look) -> Iterator[str]:
    """Of each command of another node that reaches a bridge that hears its plant, people are told."""
    for command in look.record.others.untold:
        yield f"nobody is told of {command}, which another node gave"


@invariant(Trigger.COMMANDED)
def a_shared_device_serves_one_cell(look: Look) -> Iterator[str]:
    """A device that cells share is commanded by the cell that holds it, once another one's work has ended."""
    plant, shared = look.world.plant, look.world.model.shared
    for sent in look.record.commands.new if shared else ():
        if sent.robot not in shared or sent.entry is None:
            continue
        device, cell, holder = sent.robot, sent.entry.cell, plant.zones.holder(sent.robot)
        if holder != cell:
            yield f"{device} is told something by {cell}, and {holder} holds it"
        others = {each.cell for each in plant.dispatcher.ledger.of_robot(device)}
        if len(others) > 1:
            yield f"{device} works for {', '.join(sorted(others))} at the same time"


DEVICES = (
    what_is_done_was_so,
    what_a_task_left_is_so,
    needs_hold,
    no_command_against_a_need,
    finishing_work_is_finished,
    nothing_is_dropped,
    an_answer_is_to_its_question,
    commands_of_others_are_told,
    a_shared_device_serves_one_cell,
)
