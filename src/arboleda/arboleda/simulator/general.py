"""Invariants for a plant of any devices, judged by their true facts, whatever kinds of device they are.

Most of what holds for storage holds everywhere and is looked at here, too; only storage has paths, stations
and a task grammar of its own. The rules of this file are those of devices, which have facts.
"""

from __future__ import annotations

import json
from collections.abc import Iterator

from arboleda.dispatch.ledger import State
from arboleda.model.commands import Motion, Query
from arboleda.model.facts import Value
from arboleda.model.messages import OperatorAnswer, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import Evidence, MotionState, PlantModel
from arboleda.recipes.storage import only_stores
from arboleda.wire.hop import FromPlant
from arboleda.wire.payloads import OrderGoal
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Publication

from .commands import goal as goal_of
from .invariants import bridge, commands, liveness, motion, tasks, verbs, wire
from .invariants.advice import ADVICE
from .invariants.beliefs import BELIEFS
from .invariants.choices import CHOICES
from .invariants.done import tiny_moves_succeed
from .invariants.invariant import Invariant, Look, Trigger, invariant
from .invariants.memory import MEMORY
from .invariants.memory_bounds import BOOKS
from .invariants.oee import OEE
from .invariants.proofs import PROOFS
from .invariants.starts import EVERYWHERE as OVER_ALL_STARTS
from .invariants.stop import STOP
from .invariants.zones import ZONES
from .truth.ended_commands import EndedCommand
from .truth.robot import RobotTruth
from .truth.robots import RobotsTruth
from .truth.stops import is_order_of, robots_of
from .world import World

KEPT = 16  # commands of a robot that may still be under way to its board
RELEASE_S = 60.0  # within which an operator's release opens a tool


def is_general(model: PlantModel) -> bool:
    """True if a plant has a cell, or a recipe, that the invariants of storage do not know."""
    return not all(map(only_stores, model.cells))


class GeneralTruth(RobotsTruth):
    """The true facts of robots and devices, since when they are so, and devices' true answers.

    `done_tasks` of this step: the cells whose task is called done, the task, and since when it ran.
    """

    def __init__(self, world: World) -> None:
        super().__init__(world)
        self.done_tasks: list[tuple[str, str, float]] = []
        self._facts = {name: dict(robot.body.true_facts) for name, robot in self.robots.items()}
        self._left: dict[tuple[str, object], float] = {}  # when a fact ceased to be so, a target was left
        self._released: dict[str, float] = {}  # when an operator had a robot let go
        self._last: dict[str, EndedCommand] = {}  # the last command of each robot, if it is called done
        self._asked: dict[tuple[str, int, int], str] = {}  # (robot, epoca, seq) -> the question
        self._answers: dict[str, set[Value]] = {}  # what was truly answered to it
        self._began: dict[str, float] = {}
        robots = [each.robot for each in self.robots.values()]
        self._telemetry = {topic(robot.mqtt, Channel.TELEMETRY): robot.name for robot in robots}
        self._orders = {topic(robot.mqtt, Channel.ORDER): robot.name for robot in robots}

    def was_so(self, robot: str, fact: str, value: Value, since: float) -> bool:
        """True if a robot truly had this value of a fact at some time since `since`."""
        return self._facts[robot].get(fact) == value or self._left_since(robot, (fact, value), since)

    def stood_at(self, robot: str, command: Motion, since: float) -> bool:
        """True if a robot truly stood at a command's goal since `since`, or if that is no target."""
        space = self.world.model.cell_of[robot].workspaces.get(robot)
        names = [pose.name for pose in space.poses if pose.q == command.way[-1]] if space else []
        here = self.robots[robot].here
        return not names or any(name in here or self._left_since(robot, name, since) for name in names)

    def released(self, robot: str) -> bool:
        """True while what a robot holds may be let go on an operator's word."""
        return self._released.get(robot, -RELEASE_S) + RELEASE_S >= self.world.now

    def answers(self, question: str) -> set[Value]:
        """The answers that a device has truly given to the query with this id."""
        return self._answers.get(question, set())

    def last_done(self, robot: str) -> EndedCommand | None:
        """The last command of a robot, questions left out, if it is called done."""
        return self._last.get(robot)

    def look(self) -> None:
        if self.done_tasks:
            self.done_tasks = []
        super().look()
        for booked in self.books.ended:
            self._end(booked)
        for passed in self.world.moment.bridged:
            self._follow_questions(passed.events, passed.out)
        for client, publication in self.world.moment.published:
            if client and b'"respuesta"' in publication.payload and publication.topic in self._telemetry:
                self._hear_answer(self._telemetry[publication.topic], publication.payload)

    def _left_since(self, robot: str, what: object, since: float) -> bool:
        return self._left.get((robot, what), -1.0) >= since

    def _new_plant(self) -> None:
        """Forget the last commands of robots: a new plant has no book of what became of them."""
        super()._new_plant()
        self._last.clear()

    def _look_at_robots(self) -> None:
        super()._look_at_robots()
        now = self.world.now
        for robot in self.changed:
            name, facts = robot.robot.name, dict(robot.body.true_facts)
            for fact, value in self._facts[name].items():
                if facts.get(fact) != value:
                    self._left[name, (fact, value)] = now
            self._facts[name] = facts
            self._left.update({(name, pose): now for pose in robot.stood})

    def _end(self, booked: EndedCommand) -> None:
        command = booked.command
        if booked.done and not isinstance(command, Query):
            self._last[command.robot] = booked
        elif not isinstance(command, Query):
            self._last.pop(command.robot, None)

    def _follow_questions(self, events: list[object], out: list[object]) -> None:
        """Take in the questions that the bridge sent on, each under a number."""
        said = [each.message for each in events if isinstance(each, FromPlant)]
        asked = [each for each in said if isinstance(each, Query) and each.id]
        for each in out if asked else ():
            name = self._orders.get(each.topic) if isinstance(each, Publication) else None
            if name is None or not isinstance(each, Publication):
                continue
            goal = goal_of(each.topic, each.payload, self.robots[name].body.axes)
            for question in [each for each in asked if each.robot == name]:
                if isinstance(goal, OrderGoal) and is_order_of(goal, self.robots[name].robot, question):
                    asked.remove(question)
                    self._asked[name, goal.epoch or 0, goal.seq or 0] = question.id
                    break

    def _hear_answer(self, robot: str, payload: bytes) -> None:
        """Take in the answer in a board's telemetry; it belongs to the question with this number."""
        said = json.loads(payload)
        question = self._asked.get((robot, said.get("epoca_ack"), said.get("respuesta_seq")))
        if question is not None:
            self._answers.setdefault(question, set()).add(said["respuesta"])

    def _take_in(self, message: object) -> None:
        if isinstance(message, TaskChanged):
            self._task(message)
        else:
            super()._take_in(message)

    def _task(self, change: TaskChanged) -> None:
        cell = change.cell or ""
        if change.state is TaskState.RUNNING and change.request is None:
            self._began[cell] = self.world.now
        elif change.state is TaskState.DONE and change.request is None:
            self.done_tasks.append((cell, change.task, self._began.get(cell, self.world.now)))

    def _answered(self, answer: OperatorAnswer) -> None:
        super()._answered(answer)
        if answer.verb is Verb.RELEASE:
            self._released.update(dict.fromkeys(robots_of(self.world.model, answer.scope), self.world.now))


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


def _unprovable(truth: GeneralTruth, booked: EndedCommand, robot: RobotTruth) -> bool:
    """True if a robot's reports prove nothing of a command, by its evidence or by lies.

    At `ids` work shows in two ways, its number and what it sets, and both must be lies; a switch shows in
    what it sets alone.
    """

    def lies(what: str) -> bool:
        return truth.deceived_since(robot.robot.mqtt, what, booked.sent_at)

    if robot.blind or robot.put_right_at >= booked.sent_at:
        return True
    if robot.robot.evidence is Evidence.IDS and booked.entry.is_work:
        return lies("done") and lies(robot.PLACE)
    return booked.late or lies(robot.PLACE) or lies("effector") or lies("state")


@invariant(Trigger.DONE_TASKS)
def what_a_task_left_is_so(look: Look) -> Iterator[str]:
    """A task that is called done leaves each of its devices as the last command to that has set it, unless
    power, somebody's hand or a lie has changed that.
    """
    truth = look.truth
    for cell, task, began in truth.done_tasks:
        for robot in look.world.model.cell(cell).robots:
            booked = truth.last_done(robot.name)
            if booked is None or booked.sent_at < began:
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


def _is_said_too_early(truth: GeneralTruth, hand: RobotTruth) -> bool:
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


OF_DEVICES = (
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
"""What must hold of devices."""

OF_STORAGE = frozenset({tasks.no_task_fails_without_a_fault, liveness.zone_requests_end})
EVERYWHERE: tuple[Invariant, ...] = (
    *ZONES,
    motion.no_unhomed_move,
    motion.no_move_after_a_boot_that_was_told,
    motion.nothing_moves_unasked,
    motion.arm_stays_within_limits,
    tiny_moves_succeed,
    *STOP,
    *commands.COMMANDS,
    *PROOFS,
    *wire.WIRE,
    *bridge.BRIDGE,
    *BELIEFS,
    *(each for each in tasks.TASKS if each not in OF_STORAGE),
    *CHOICES,
    *verbs.VERBS,
    *ADVICE,
    *MEMORY,
    *(each for each in liveness.LIVENESS if each not in OF_STORAGE),
    *BOOKS,
    *OEE,
    *OVER_ALL_STARTS,
)
"""What must hold where parts are stored, and anywhere else."""

GENERAL = (*EVERYWHERE, *OF_DEVICES)
