"""The truth about a plant, step by step: its robots and devices, their facts and answers, and its parts."""

from __future__ import annotations

import json

from arboleda.drivers import Command, Motion, Query, Report, Value
from arboleda.engine.inspection import not_given_count_of, teaching_of
from arboleda.model.messages import ENDED, Check, Fact, OperatorAnswer, TaskChanged, TaskState, Verb
from arboleda.model.whole_cells import whole_cell
from arboleda.rig.world import World
from arboleda.wire.hop import FromPlant
from arboleda.wire.payloads import VerbGoal
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Publication

from ..commands import goal as goal_of
from .ended_commands import EndedCommand, LastAnswers
from .grips import GripsTruth
from .part_places import PlacesTruth
from .refused_commands import RefusedCommands
from .robots import RobotsTruth
from .shared_devices import SharedDevicesTruth
from .stops import is_order_of, robots_of

RELEASE_S = 60.0  # within which an operator's release opens a tool


class Truth(RobotsTruth):
    """The true facts of robots and devices, since when they are so, and devices' true answers.

    Of this step: `begun_tasks`, the cells whose task began, and the task; `done_tasks`, those whose task is
    called done, the task, and since when it ran.
    """

    def __init__(self, world: World) -> None:
        super().__init__(world)
        self.grips = GripsTruth(world, self.robots, self.unseen)
        effectors = self.grips.effectors
        self.places = PlacesTruth(
            world, self.robots, effectors, mistaken=self.mistaken, released=self.released
        )
        self.shared = SharedDevicesTruth(world, self.robots)
        self.last_answers = LastAnswers()
        self.begun_tasks: list[tuple[str, str]] = []
        self.done_tasks: list[tuple[str, str, float]] = []
        self.unchecked: dict[str, tuple[Check, ...]] = {}  # of those, what nobody confirmed
        self._at_work = _tasks_at_work(world)
        self._refused_commands = RefusedCommands()
        self._facts = {name: dict(robot.body.true_facts) for name, robot in self.robots.items()}
        self._left: dict[tuple[str, object], float] = {}  # when a fact ceased to be so, a target was left
        self._released: dict[str, float] = {}  # when an operator had a robot let go
        self._last: dict[str, EndedCommand] = {}  # the last command of each robot, questions left out
        self._questions: dict[tuple[str, int, int], str] = {}  # (robot, epoca, seq) -> the question
        self._answers: dict[str, set[Value]] = {}  # what was truly answered to it
        self._began: dict[str, float] = {}
        robots = [each.robot for each in self.robots.values()]
        self._telemetry = {topic(robot.mqtt, Channel.TELEMETRY): robot.name for robot in robots}
        self._orders = {topic(robot.mqtt, Channel.ORDER): robot.name for robot in robots if robot.verb_names}

    def was_so(self, robot: str, fact: str, value: Value, since: float) -> bool:
        """True if a robot truly had this value of a fact at some time since `since`."""
        return self._facts[robot].get(fact) == value or self._left_since(robot, (fact, value), since)

    def stood_at(self, robot: str, command: Motion, since: float) -> bool:
        """True if a robot truly stood at a command's goal since `since`, or if that is no target."""
        space = whole_cell(self.world.model, robot).workspaces.get(robot)
        names = [pose.name for pose in space.poses if pose.q == command.way[-1]] if space else []
        here = self.robots[robot].here
        return not names or any(name in here or self._left_since(robot, name, since) for name in names)

    def released(self, robot: str) -> bool:
        """True while what a robot holds may be let go on an operator's word."""
        return self._released.get(robot, -RELEASE_S) + RELEASE_S >= self.world.now

    def answers(self, question: str) -> set[Value]:
        """The answers that a device has truly given to the query with this id."""
        return self._answers.get(question, set())

    def last_ended(self, robot: str) -> EndedCommand | None:
        """The last command of a robot that has ended, questions left out."""
        return self._last.get(robot)

    def last_done(self, robot: str) -> EndedCommand | None:
        """The same, if it is called done."""
        last = self._last.get(robot)
        return last if last is not None and last.done else None

    def _did_more(self) -> bool:
        return bool(self.begun_tasks or self.grips.stray)

    def _forget(self) -> None:
        super()._forget()
        self.grips.forget()
        if self.begun_tasks:
            self.begun_tasks = []
        self.places.forget()

    def _follow_changes(self) -> None:
        super()._follow_changes()
        self.grips.follow(self.changed)
        if self.places.cells:
            self.places.follow(self.changed)
        self._follow_facts()

    def _listen(self, reports: list[Report]) -> None:
        if self.grips.effectors:
            self.grips.hear(reports)
        super()._listen(reports)

    def look(self) -> None:
        if self.done_tasks:
            self.done_tasks, self.unchecked = [], {}
        super().look()
        if self.world.model.shared:
            self.shared.look()
        for booked in self.books.ended:
            self._end(booked)
        plant = self.world.plant
        if self.places.cells and not_given_count_of(plant):
            for refused in self._refused_commands.fresh(plant):
                self.places.take_refusal(refused)
        if not self._orders:
            return
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
        kept = self.world.plant_process.found.facts.get(Fact.PARTS, {})
        self.places.restart(self.world.moment.last_words, kept)
        self.grips.restart()
        self._last.clear()
        self._at_work = _tasks_at_work(self.world)

    def _follow_facts(self) -> None:
        """Note since when a fact is not so any more, and robots stand at a target no more."""
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
        self.places.end(booked.entry)
        if isinstance(command, Query):
            self.last_answers.take(booked)
        else:
            self._last[command.robot] = booked

    def _follow_questions(self, events: list[object], out: list[object]) -> None:
        """Take in the questions that the bridge sent on, each under a number."""
        messages = [each.message for each in events if isinstance(each, FromPlant)]
        questions = [each for each in messages if isinstance(each, Query) and each.id]
        for each in out if questions else ():
            name = self._orders.get(each.topic) if isinstance(each, Publication) else None
            if name is None or not isinstance(each, Publication):
                continue
            goal = goal_of(each.topic, each.payload, self.robots[name].body.axes)
            for question in [each for each in questions if each.robot == name]:
                if isinstance(goal, VerbGoal) and is_order_of(goal, self.robots[name].robot, question):
                    questions.remove(question)
                    self._questions[name, goal.epoch or 0, goal.seq or 0] = question.id
                    break

    def _hear_answer(self, robot: str, payload: bytes) -> None:
        """Take in the answer in a board's telemetry; it belongs to the question with this number."""
        fields = json.loads(payload)
        question = self._questions.get((robot, fields.get("epoca_ack"), fields.get("respuesta_seq")))
        if question is not None:
            self._answers.setdefault(question, set()).add(fields["respuesta"])

    def _take_in(self, message: object) -> None:
        if isinstance(message, TaskChanged):
            self._task(message)
            self.places.task(message)
        else:
            super()._take_in(message)

    def _command(self, command: Command) -> None:
        super()._command(command)
        self.grips.command(command, runs=self._may_grip)
        self.places.command(command)

    def _may_grip(self, cell: str) -> bool:
        """True for a cell with a task at work, or that somebody teaches; where nobody knows which it is."""
        run = self.world.plant.cells.get(cell)
        return run is None or cell in self._at_work or teaching_of(run) is not None

    def _task(self, change: TaskChanged) -> None:
        cell = change.cell or ""
        if change.state is TaskState.RUNNING and change.request is None:
            self._began[cell] = self.world.now
            self._at_work[cell] = change.task
            self.begun_tasks.append((cell, change.task))
            return
        if change.state in ENDED and self._at_work.get(cell) == change.task:
            del self._at_work[cell]
        if change.state is TaskState.DONE and change.request is None:
            self.done_tasks.append((cell, change.task, self._began.get(cell, self.world.now)))
            self.unchecked[change.task] = change.unchecked

    def _answered(self, answer: OperatorAnswer) -> None:
        super()._answered(answer)
        if self.places.cells and answer.verb in (Verb.LOAD, Verb.UNLOAD):
            self.places.take_answer(answer)
        if answer.verb.row.drops:
            robots = robots_of(self.world.model, answer.scope)
            self._released.update(dict.fromkeys(robots, self.world.now))


def _tasks_at_work(world: World) -> dict[str, str]:
    """The task at work in each cell that has one."""
    return {name: run.task.id for name, run in world.plant.cells.items() if run.task is not None}
