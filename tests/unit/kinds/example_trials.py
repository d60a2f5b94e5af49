"""Examples of cells of devices, tried: whatever is answered or gives up, the cell works again.

`cases` are all cases of a test, by which is known which answers are tried.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from itertools import combinations
from pathlib import Path

from tests.following import follow, works
from tests.lengths import length, sample

from arboleda.geometry import bodies, kinematics
from arboleda.kinds.arm import Arm, SetEffector
from arboleda.kinds.declared import Device, VerbCall
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command, Position, Question
from arboleda.model.facts import Value
from arboleda.model.messages import TaskState, Verb
from arboleda.model.plant_model import Link, PlantModel, Workspace
from arboleda.plant_file import loader
from arboleda.plant_file.urdf import robot_urdf
from arboleda.sim.arm import ArmBody
from arboleda.sim.machine import MachineBody
from arboleda.wire.payloads import VerbGoal

from .lab import Bench

EXAMPLES = Path(__file__).parents[3] / "examples"
OF_STORAGE = "scara_pair"  # its cells are of an arm, a mobile robot and a rack; it brings tests of its own
OF_DRIVERS = (
    "agv",
    "mixed",
    "nav2",
    "plc_conveyor",
    "ros2_control",
)  # tried by the tests of arboleda_drivers
OF_TREES = ("own_tree",)  # by those of arboleda_trees
ENDED = (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED, TaskState.REFUSED)
SAME_M, APART_M = 0.001, 0.05


@dataclass(frozen=True, kw_only=True)
class Case:
    """A task of an example, what is answered in it (else the first that there is), and what is told last."""

    folder: str
    task: str
    answers: dict[str, str] = field(default_factory=dict)
    ends_with: tuple[str, ...] = ()
    why: str | None = None  # the task fails, with this sentence
    tries_again: frozenset[tuple[str, str]] = frozenset()  # what the recipe itself answers a failure of
    is_so: frozenset[tuple[str, str]] = frozenset()  # what a device shows already when it is first told so

    def __str__(self) -> str:
        return " ".join([self.task, *self.answers.values()])

    @property
    def cell(self) -> str:
        return self.task.split()[0]


@cache
def load(folder: str) -> PlantModel:
    """The plant of an example, as it is simulated."""
    return loader.load(EXAMPLES / folder / "plant.yaml").on_boards(Link.DRIVER)


def tried(cases: Sequence[Case], folder: str, name: str, answers: Iterable[Value]) -> set[Value]:
    """Those of the answers of somebody that a case gives, the first among them."""
    first, *_ = answers
    return {first, *(each.answers[name] for each in cases if each.folder == folder and name in each.answers)}


class Shop(Bench):
    """An example; who is asked answers as the case says."""

    def __init__(self, case: Case, cases: Sequence[Case]) -> None:
        super().__init__(load(case.folder))
        self.case = case
        self.cases = cases
        self.devices_by_name = {
            name: self.machines[robot.mqtt]
            for name, robot in self.model.robots.items()
            if isinstance(robot, Device)
        }
        for name in self.devices_by_name.keys() & case.answers.keys():
            self.body(name).answer = partial(self._answer, name)

    def body(self, name: str) -> MachineBody:
        body = self.devices_by_name[name]
        assert isinstance(body, MachineBody)
        return body

    def do(self) -> TaskState:
        """Ask for the task of the case, answer what people are asked, and see how it ends."""
        self.submit(self.case.task)
        while not self._ended():
            assert self.wait(600.0, lambda: self._ended() or bool(self._questions())), self.changes[-1]
            for asked in self._questions():
                answers = asked.answers
                known = tried(self.cases, self.case.folder, asked.robot, answers)
                assert set(answers) == known & set(answers)
                word = self.case.answers.get(asked.robot, answers[0])
                assert self.operate(Verb.ANSWER, asked.robot, answer=word) is None
        return self.changes[-1].state

    @property
    def said(self) -> list[str]:
        """What devices and robots were told, in order, without stops and heights: `left to done`."""
        words = (self._said(each) for each in self.sent if isinstance(each, Command))
        return [each for each in words if each]

    def holding(self) -> list[str]:
        """Who truly holds something."""
        arms = [
            name
            for name, board in self.boards.items()
            if isinstance(board.body, ArmBody) and board.body.effector
        ]
        kinds = {name: self.body(name).kind.held_fact for name in self.devices_by_name}
        return arms + [name for name, fact in kinds.items() if fact and self.body(name).facts[fact]]

    def _said(self, command: Command) -> str | None:
        if isinstance(command, VerbCall):
            return f"{command.robot} {command.verb}"
        if isinstance(command, SetEffector):
            return f"{command.robot} {'grips' if command.on else 'lets go'}"
        if isinstance(command, MoveJoints):
            return self._going(command.robot, command.q)
        return self._going(command.robot, command.nodes[-1]) if isinstance(command, FollowPath) else None

    def _going(self, robot: str, goal: Position) -> str | None:
        poses = self.model.cell_of[robot].workspaces[robot].poses
        name = next((pose.name for pose in poses if pose.q == goal), None)
        return name and f"{robot} to {name}"

    def _answer(self, name: str, goal: VerbGoal) -> Value:
        return self.case.answers[name]

    def _ended(self) -> bool:
        return self.changes[-1].state in ENDED

    def _questions(self) -> list[Question]:
        entries = map(self.plant.dispatcher.ledger.question, self.model.robots)
        return [each.command for each in entries if each is not None and isinstance(each.command, Question)]


def every_answer_is_tried(folder: str, cases: Sequence[Case]) -> None:
    """Each recipe of an example has a case, and so has each answer of its devices."""
    model = load(folder)
    names = {tuple(case.task.split()[:2]) for case in cases if case.folder == folder}
    assert names == {(cell.name, recipe.name) for cell in model.cells for recipe in cell.recipes}
    for device in model.robots.values():
        for verb in device.kind.verbs.values() if isinstance(device, Device) else ():
            if verb.answers:
                assert tried(cases, folder, device.name, verb.answers) == set(verb.answers)


def ends_as_the_recipe_says(case: Case, cases: Sequence[Case]) -> None:
    """A task ends as its recipe says, and the cell works again, with nothing held."""
    here = Shop(case, cases)
    state = here.do()
    assert state is (TaskState.FAILED if case.why else TaskState.DONE), here.changes[-1]
    if case.why:
        assert str(here.changes[-1].sentence) == case.why
    assert tuple(here.said[len(here.said) - len(case.ends_with) :]) == case.ends_with
    assert here.wait(60.0, lambda: works(here, case.cell))
    assert here.holding() == []


def works_again_after_a_device_gave_up(case: Case, cases: Sequence[Case]) -> None:
    """After any device gave up the first advice leads back to work."""
    whole = Shop(case, cases)
    assert whole.do() is TaskState.DONE
    deeds = {tuple(each.split()) for each in whole.said if each.split()[0] in whole.devices_by_name}
    assert deeds
    for name, verb in sample(sorted(deeds - case.tries_again - case.is_so), every=2):
        here, given_up = Shop(case, cases), []

        def fails(goal: VerbGoal, verb: str = verb, given_up: list[VerbGoal] = given_up) -> str | None:
            """Gives up that verb the first time that it is told."""
            if goal.verb != verb or given_up:
                return None
            given_up.append(goal)
            return "atasco"

        here.body(name).fails = fails
        assert here.do() is TaskState.FAILED, (name, verb)
        done = follow(here, case.cell)
        assert here.holding() == [], (name, verb, done)
        assert here.do() is TaskState.DONE, (name, verb, done, here.changes[-1])


def works_again_after_a_stop(case: Case, cases: Sequence[Case]) -> None:
    """After a stop at any time the first advice leads back to work."""
    whole = Shop(case, cases)
    assert whole.do() is TaskState.DONE
    for count in range(1, len(whole.said), length(8, whole=4)):
        here = Shop(case, cases)
        here.submit(case.task)
        assert here.wait(200.0, lambda here=here, count=count: len(here.said) >= count)
        assert here.operate(Verb.STOP) is None
        here.wait(1.0)
        done = [each for cell in here.plant.cells for each in follow(here, cell)]
        assert here.holding() == [], (here.said[-1], done)
        assert here.do() is TaskState.DONE, (done, here.changes[-1])


def arms(folder: str) -> list[Workspace]:
    """The workspaces of all arms of an example."""
    spaces = [space for cell in load(folder).cells for space in cell.spaces]
    return [space for space in spaces if isinstance(space.robot, Arm)]


def targets_are_places_of_their_own(folder: str) -> None:
    """A target is the same place for all arms, and another one than the others."""
    places: dict[str, list[tuple[float, ...]]] = {}
    for space in arms(folder):
        assert isinstance(space.robot, Arm)
        body, base = bodies.read(robot_urdf(load(folder), space.robot.name)), space.robot.base.on_floor
        for pose in space.poses:
            point = kinematics.at(kinematics.tool(body, pose.q, kinematics.floor(base)))
            places.setdefault(pose.name if pose is not space.home else space.robot.name, []).append(point)
    for points in places.values():
        assert all(math.dist(points[0], each) < SAME_M for each in points)
    for (name, (a, *_)), (other, (b, *_)) in combinations(places.items(), 2):
        assert math.dist(a, b) > APART_M, f"{name} and {other}"
