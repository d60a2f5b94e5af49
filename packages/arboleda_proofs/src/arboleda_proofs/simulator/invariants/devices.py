"""Invariants of devices, by their true facts, whatever kinds of device they are."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.drivers import Command, Evidence, Home, Motion, MotionState, Query, Robot, Stop, StopMode
from arboleda.engine import State
from arboleda.engine.inspection import Question, facts_of, ledger_of, tasks_of
from arboleda.model.messages import Fact, OperatorRequest, Reason, Remember, TaskState, Verb
from arboleda.wire.hop import shown

from ..recorded.commands import SentCommand
from ..truth.ended_commands import EndedCommand
from ..truth.robot import RobotTruth
from ..truth.robots import LATE_BOOT_S
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
        if not isinstance(command, Motion) or not command.way:
            continue
        if not truth.stood_at(command.robot, command, booked.sent_at):
            yield f"{command.robot} never stood at the goal of {what}"


def _unprovable(truth: Truth, booked: EndedCommand, robot: RobotTruth) -> bool:
    """True if a robot's reports prove nothing of a command, by its evidence or by lies.

    At `ids` work shows in two ways, its number and what it sets, and both must be lies; a switch shows in
    what it sets alone.
    """

    def lies(what: str) -> bool:
        return truth.deceived_since(robot.robot.mqtt, what, booked.sent_at)

    if robot.blind or robot.put_right_at >= booked.sent_at or _booted_unheard(robot, booked.sent_at):
        return True
    if not booked.entry.is_work and not _tells_switches(robot.robot):
        return True
    if robot.robot.evidence is Evidence.IDS and booked.entry.is_work:
        return lies("done") and lies(robot.PLACE)
    return booked.late or lies(robot.PLACE) or lies("effector") or lies("state")


def _booted_unheard(robot: RobotTruth, at: float) -> bool:
    """True for a device that booted shortly before, where boots have no number: nobody hears of them."""
    return robot.robot.evidence is not Evidence.IDS and at < robot.booted_us / 1e6 + LATE_BOOT_S


def _may_have_failed_unseen(truth: Truth, booked: EndedCommand, robot: Robot) -> bool:
    """True if a fault may have kept a device from what it was told, and it reports nothing of that."""
    return robot.evidence is Evidence.STATE and not truth.books.calm_since(booked.sent_at)


def _tells_switches(robot: Robot) -> bool:
    """False for an arm whose effector counts as switched after a time, as nobody reports anything of it."""
    return robot.evidence is Evidence.IDS or not robot.has_effector


@invariant(Trigger.DONE_TASKS)
def what_a_task_left_is_so(look: Look) -> Iterator[str]:
    """A task that is called done leaves each of its devices as its last command to that has set it, unless
    power, somebody's hand, a lie or another cell that shares it has changed that; an effector of which nobody
    reports anything counts as switched after a time, and so does a device at `state`, which is judged while
    nothing goes wrong.
    """
    truth, last_sent = look.truth, ledger_of(look.world.plant).last_sent
    for cell, task, began in truth.done_tasks:
        of_task = look.world.model.cell(cell)
        for robot in of_task.robots:
            booked = truth.last_done(robot.name)
            if booked is None or booked.sent_at < began or booked.entry.cell != cell:
                continue
            if not _tells_switches(robot) or _may_have_failed_unseen(truth, booked, robot):
                continue
            last = last_sent.get(robot.name)
            if robot.name in of_task.shared and last is not None and last.sent_at > booked.sent_at:
                continue
            for name, value in booked.command.sets:
                body = truth.robot(robot.name)
                since = max(body.booted_us / 1e6, body.put_right_at)
                if _booted_unheard(body, booked.sent_at):
                    continue
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


@invariant(Trigger.COMMANDED)
def no_command_against_a_need_of_others(look: Look) -> Iterator[str]:
    """No command leaves, but an operator's release or home, while another device of its cell has said last
    that what the command needs of it is not so, or is not heard.
    """
    for sent in look.record.commands.new:
        cell = look.world.model.cell(sent.entry.cell) if sent.entry is not None else None
        by_operator = isinstance(sent.command, Home) or look.truth.released(sent.robot)
        if cell is None or not cell.needs or by_operator:
            continue
        for need in cell.needs:
            known = look.record.robots[need.other]
            if (need.device, need.word) == (sent.robot, sent.command.word) and (
                known.fact(need.fact) != need.value or known.offline(look.record.step.at)
            ):
                yield f"{sent} leaves, needs {need.fact} of {need.other} {need.value}, which said otherwise"


@invariant(Trigger.CHANGED)
def finishing_work_is_finished(look: Look) -> Iterator[str]:
    """Work that goes on through a stop ends in its own time, unless power, an alarm or an order ends it."""
    for robot in look.truth.changed:
        if robot.cut_short:
            yield f"{robot.robot.name} was cut short in what it was to finish"


@invariant(Trigger.NEWS)
def finishing_work_is_not_halted(look: Look) -> Iterator[str]:
    """Work that goes on through a stop is neither halted nor called off when its step is left."""
    commands = look.record.commands
    for sent, _ in commands.moved:
        if sent.finishes and (sent.state in (State.CANCELLING, State.CANCELLED) or _failed_by_stop(sent)):
            yield f"{sent} was called off, and was to finish"
    at_work = {id(sent) for sent in (*commands.open.values(), *(sent for sent, _ in commands.moved))}
    told = [*look.moment.sent]
    for number, stop in enumerate(told, start=1):
        if not isinstance(stop, Stop) or stop.mode is not StopMode.HALT:
            continue
        last = commands.last_work.get(stop.robot)
        if last is not None and last.command in told[number:]:
            continue  # it leaves after the halt, which was for what came before
        if last is not None and last.finishes and id(last) in at_work and not _is_forged(look, stop.robot):
            yield f"{last} was halted, and was to finish"


def _failed_by_stop(sent: SentCommand) -> bool:
    """True if a command that its robot had not refused was taken to have ended by a stop."""
    failure = sent.entry.failure if sent.entry and sent.state is State.FAILED else None
    return failure is not None and failure.reason is Reason.STOPPED and not sent.rejected


def _is_forged(look: Look, robot: str) -> bool:
    """True if the robot has said in this step that it took a command that the plant never gave it."""
    given = {command.id for command in look.record.commands.goals.get(robot, ())}
    accepted = {report.accepted for report in look.moment.reports if report.robot == robot}
    return not accepted - {None} <= given


@invariant(Trigger.CHANGED)
def nothing_is_dropped(look: Look) -> Iterator[str]:
    """A robot lets go of what it carries only where it stands at a target, or on an operator's word; where
    its tool has said too early that it had let go, nobody could know.
    """
    truth = look.truth
    if not [robot for robot in truth.changed if robot.let_go]:
        return
    for cell in look.world.model.cells:
        for space in cell.spaces:
            hand, carrier = truth.robot(space.hand.name), truth.robot(space.robot.name)
            if hand not in truth.changed or carrier is None or not hand.let_go:
                continue
            places = carrier.here | carrier.stood
            excused = carrier.taken_away or truth.released(space.hand.name) or truth.mistaken(carrier)
            if not places and not excused and not _is_settled_by_a_lie(truth, hand):
                yield f"{space.hand.name} lets go, and {space.robot.name} stands at no target"


def _is_settled_by_a_lie(truth: Truth, hand: RobotTruth) -> bool:
    """True if a lie about what a tool holds tells of the end of its last command, also of one given up."""
    booked = truth.last_ended(hand.robot.name)
    return booked is not None and truth.deceived_since(hand.robot.mqtt, hand.PLACE, booked.sent_at)


@invariant(Trigger.BOOKED)
def an_answer_is_to_its_question(look: Look) -> Iterator[str]:
    """The answer that counts for a question is one that its device has given to this very question."""
    truth = look.truth
    for booked in truth.books.ended:
        if not booked.done or not isinstance(booked.command, Query):
            continue
        board = look.world.model.robots[booked.command.robot].mqtt
        answer = booked.entry.answer
        if answer not in truth.answers(booked.command.id) and not truth.deceived_since(
            board, "answer", booked.sent_at
        ):
            yield f"{booked.command.robot} has not answered {answer!r} to {booked.command.id}"


@invariant(Trigger.ASKED)
def offered_answers_are_accepted(look: Look) -> Iterator[str]:
    """An answer that a question offers is accepted from whoever gives it while that question is open."""
    refused = {
        each.scope
        for each in look.record.operator_requests.answers
        if each.verb is Verb.ANSWER and each.refusal
    }
    for request in look.moment.requests if refused else ():
        if not isinstance(request, OperatorRequest) or request.verb is not Verb.ANSWER:
            continue
        entry = ledger_of(look.world.plant).question(request.scope)
        if entry is None or entry.sent_at >= request.at or request.scope not in refused:
            continue
        if _is_offered(entry.command, request):
            yield f"{request.scope} may not answer {request.argument('answer')!r}, which is offered"


def _is_offered(command: Command, request: OperatorRequest) -> bool:
    is_meant = request.argument("question") in (None, command.id)
    return is_meant and isinstance(command, Question) and request.argument("answer") in command.answers


@invariant(Trigger.UNTOLD)
def commands_of_others_are_told(look: Look) -> Iterator[str]:
    """Of each command of another node that reaches a bridge that hears its plant, people are told."""
    for command in look.record.others.untold:
        yield f"nobody is told of {shown(command)} for {command.robot}, which another node gave"


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
        others = {each.cell for each in ledger_of(plant).of_robot(device)}
        if len(others) > 1:
            yield f"{device} works for {', '.join(sorted(others))} at the same time"


@invariant(Trigger.SENT)
def a_shared_device_is_handed_on_empty_at_home(look: Look) -> Iterator[str]:
    """A robot that cells share is handed on at its home, and what holds parts is handed on empty,
    unless its board lies or a person has said that it is empty.
    """
    model, truth = look.world.model, look.truth
    given_back = [each for each in look.moment.sent if isinstance(each, Remember) and _gives_back(each)]
    for name in (each.name for each in given_back if each.name in model.shared):
        body = truth.robot(name)
        if body is None or truth.mistaken(body):
            continue
        space = model.cell_of[name].reach.get(name)
        if space is not None and space.home.name not in body.here | body.stood:
            yield f"{name} is given back, and stands at {', '.join(sorted(body.here)) or 'no target'}"
        if _truly_holds(look, body):
            yield f"{name} is given back, and holds a part"


def _truly_holds(look: Look, body: RobotTruth) -> bool:
    """True for what holds a part while nothing says else, neither a lie of its board nor a person."""
    fact = body.robot.held_fact
    if fact is None or body.body.true_facts.get(fact) is not True:
        return False
    what = "effector" if body.robot.goes else body.PLACE
    lies = look.truth.deceived_since(body.robot.mqtt, what, look.world.now)
    return not lies and not _is_said_to_be_empty(look, body.robot.name)


def _is_said_to_be_empty(look: Look, name: str) -> bool:
    """True if a person has said so, in this step or before: the next cell may have it already."""
    said = (each for each in look.moment.sent if isinstance(each, Remember) and each.value is not None)
    if any((each.fact, each.name) == (Fact.EMPTIED, name) for each in said):
        return True
    return facts_of(look.world.plant).value(Fact.EMPTIED, name) is not None


def _gives_back(message: Remember) -> bool:
    return message.fact is Fact.QUARANTINE and message.value is None


@invariant(Trigger.TOLD)
def numbers_lie_within_their_limits(look: Look) -> Iterator[str]:
    """A task is accepted only with numbers within the limits of its recipe."""
    for change in look.record.tasks.changes:
        known = tasks_of(look.world.plant).get(change.message.task)
        if change.message.state is not TaskState.QUEUED or change.answer or known is None:
            continue
        cell = look.world.model.cell(known.order.cell)
        found = [each for each in cell.recipes if each.name == known.order.recipe]
        for parameter in (each for recipe in found for each in recipe.parameters):
            limits, value = parameter.limits(cell), known.order.values.get(parameter.name)
            if limits and isinstance(value, int | float) and not limits.lower <= value <= limits.upper:
                task = f"task {known.id} was accepted with {parameter.name} {value:g}"
                yield f"{task}, allowed is {limits.lower:g} to {limits.upper:g}"


DEVICES = (
    what_is_done_was_so,
    what_a_task_left_is_so,
    needs_hold,
    no_command_against_a_need,
    no_command_against_a_need_of_others,
    finishing_work_is_finished,
    finishing_work_is_not_halted,
    nothing_is_dropped,
    an_answer_is_to_its_question,
    offered_answers_are_accepted,
    commands_of_others_are_told,
    a_shared_device_serves_one_cell,
    a_shared_device_is_handed_on_empty_at_home,
    numbers_lie_within_their_limits,
)
