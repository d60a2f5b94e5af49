"""The examples of cells of devices: whatever is answered or gives up, the cell works again."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cache, partial
from itertools import combinations, groupby
from pathlib import Path

import pytest
from tests.following import follow, works
from tests.lengths import length, sample
from typer.testing import CliRunner

import arboleda.drivers
import arboleda.kinds
import arboleda.recipes
from arboleda.cli.main import cli
from arboleda.geometry import bodies, kinematics
from arboleda.kinds.arm import Arm, SetEffector
from arboleda.kinds.declared import Device, MotionCall, VerbCall
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath, Mobile
from arboleda.model.commands import Command, Position, Question
from arboleda.model.facts import Value
from arboleda.model.messages import TaskState, Verb
from arboleda.model.plant_model import Link, PlantModel, Workspace
from arboleda.model.text import parse
from arboleda.plant_file import loader
from arboleda.plant_file.urdf import robot_urdf
from arboleda.sim.arm import ArmBody
from arboleda.sim.machine import MachineBody
from arboleda.wire.payloads import OrderGoal

from .lab import Bench

EXAMPLES = Path(__file__).parents[3] / "examples"
PAGES = EXAMPLES.parent / "docs/examples"
OF_STORAGE = "scara_pair"  # its cells are of an arm, a mobile robot and a rack; it brings tests of its own
FOLDERS = sorted({file.parent.name for file in EXAMPLES.glob("*/plant.yaml")} - {OF_STORAGE})
OF_HOW_TOS = (
    "agv",
    "mixed",
    "nav2",
    "own_board",
    "own_driver",
    "own_tree",
    "plc_conveyor",
    "press_board",
    "ros2_control",
)  # their pages are in docs/how-to
SHOWN = [folder for folder in FOLDERS if folder not in OF_HOW_TOS]
WITH_ARMS = ("assembly", "kitting", "machine_tending", "mixed", "own_tree", "ros2_control")
ENDED = (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED, TaskState.REFUSED)
PUBLIC = {each.__name__: each.__all__ for each in (arboleda.drivers, arboleda.kinds, arboleda.recipes)}
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


BASE, MILL, PALLET = "station assemble base_1 lid_3", "tending mill slot_2 1002", "tending pallet 1001"
SOLD = ("tender to belt", "tender lets go", "tender to home", "belt clear")
KIT, WAVE, COLLECT = "kitting kit 2 tray_4", "kitting wave tray_1", "packing collect"
REJECTED = ("tender to reject", "tender lets go", "tender to home")
STORED = ("cart to store", "bed drop", "cart to home")
bench, tending = partial(Case, folder="lab_bench"), partial(Case, folder="machine_tending")
kitting, tree = partial(Case, folder="kitting"), partial(Case, folder="own_tree")
TAKEN = ("loader to done", "jaw open", "loader to home")
SCRAPPED = ("loader to reject", "jaw open", "loader to home")
CASES = (
    Case(folder="assembly", task=BASE, ends_with=("left to done", "left lets go", "left to home")),
    bench(task="bench weigh 10", ends_with=("pump dispense", "scale weigh")),
    bench(
        task="bench weigh 20",
        answers={"scale": "short"},
        why="the scale says that too little was dispensed",
    ),
    bench(task="bench incubate 5 60", ends_with=("heater clamp", "pump rinse")),
    bench(task="bench incubate 5 40", answers={"reader": "blank"}, ends_with=("reader scan", "pump rinse")),
    bench(task="bench incubate 5 40", answers={"reader": "unreadable"}, why="nobody can read the code"),
    tending(task=MILL, ends_with=SOLD),
    tending(task=MILL, answers={"camera": "bad"}, ends_with=REJECTED),
    tending(task=MILL, answers={"camera": "unsure"}, ends_with=SOLD),
    tending(task=MILL, answers={"camera": "unsure", "operator": "bad"}, ends_with=REJECTED),
    Case(folder="agv", task="hall fetch left right", ends_with=("forks drop", "cart to home")),
    Case(folder="agv", task="hall fetch left right", answers={"forks": "empty"}, why="nothing stood there"),
    Case(folder="mixed", task="line deliver slot_1 200", ends_with=STORED),
    Case(folder="mixed", task="line deliver slot_2 400", answers={"belt": "bad"}, ends_with=STORED),
    Case(
        folder="mixed",
        task="line deliver slot_2 100",
        answers={"belt": "bad", "operator": "no"},
        why="the part is bad",
    ),
    Case(folder="nav2", task="hall round left right", ends_with=("cart to right", "cart to home")),
    Case(folder="own_board", task="bench fill 5", ends_with=("valve dose", "valve close")),
    Case(folder="own_board", task="bench fill 10", answers={"valve": "low"}, why="the tank is low"),
    Case(folder="own_driver", task="shop form 2", ends_with=("press open", "press measure")),
    Case(
        folder="own_driver",
        task="shop form 1",
        answers={"press": "bad"},
        why="the part is out of measure",
    ),
    Case(folder="plc_conveyor", task="line pass 200", ends_with=("belt gate", "belt scan")),
    Case(folder="plc_conveyor", task="line pass 400", answers={"belt": "bad"}, why="the part is bad"),
    Case(folder="press_board", task="bench stamp 1", ends_with=("press open", "press clamp")),
    Case(folder="press_board", task="bench stamp 2", answers={"press": "absent"}, why="there is no part"),
    Case(
        folder="ros2_control",
        task="bench carry slot_1 slot_2",
        ends_with=("jaw open", "arm to home"),
        is_so=frozenset({("jaw", "open")}),
    ),
    tree(task="cell tend slot_1 1002", ends_with=TAKEN, tries_again=frozenset({("mill", "run")})),
    tree(task="cell tend slot_1 1001", answers={"camera": "bad"}, ends_with=SCRAPPED),
    tree(task="cell tend slot_2 1001", answers={"camera": "unsure"}, ends_with=TAKEN),
    tree(task="cell tend slot_2 1002", answers={"camera": "unsure", "operator": "bad"}, ends_with=SCRAPPED),
    tending(task=PALLET, ends_with=SOLD),
    tending(task=PALLET, answers={"operator": "no blanks left"}, why="no blanks are left"),
    kitting(task=KIT, ends_with=("lift roll_in", "cart_2 to home", "lift up", "picker to home")),
    kitting(task=WAVE, ends_with=("lift roll_in", "cart_3 to home", "lift up")),
    kitting(task=COLLECT, ends_with=("lift roll_out", "shuttle to table", "shuttle to home")),
    kitting(task=COLLECT, answers={"lift": "empty"}, why="no kit is on the lift"),
    kitting(task=COLLECT, answers={"packer": "no"}, why="the kit was not packed"),
)
PLAIN = [each for each in CASES if not each.answers and each.task != PALLET]
WITH_DEVICES = [each for each in PLAIN if each.folder != "nav2"]


@cache
def load(folder: str) -> PlantModel:
    """The plant of an example, as it is simulated."""
    return loader.load(EXAMPLES / folder / "plant.yaml").on_boards(Link.DRIVER)


def tried(folder: str, name: str, answers: Iterable[Value]) -> set[Value]:
    """Those of the answers of somebody that a case gives, the first among them."""
    first, *_ = answers
    return {first, *(each.answers[name] for each in CASES if each.folder == folder and name in each.answers)}


class Shop(Bench):
    """An example; who is asked answers as the case says."""

    def __init__(self, case: Case) -> None:
        super().__init__(load(case.folder))
        self.case = case
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
                assert set(answers) == tried(self.case.folder, asked.robot, answers) & set(answers)
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

    def _answer(self, name: str, goal: OrderGoal) -> Value:
        return self.case.answers[name]

    def _ended(self) -> bool:
        return self.changes[-1].state in ENDED

    def _questions(self) -> list[Question]:
        entries = map(self.plant.dispatcher.ledger.question, self.model.robots)
        return [each.command for each in entries if each is not None and isinstance(each.command, Question)]


@pytest.mark.long
def test_every_recipe_of_every_example_and_every_answer_is_tried() -> None:
    assert {case.folder for case in CASES} == set(FOLDERS)
    for folder in FOLDERS:
        model = load(folder)
        names = {tuple(case.task.split()[:2]) for case in CASES if case.folder == folder}
        assert names == {(cell.name, recipe.name) for cell in model.cells for recipe in cell.recipes}
        for device in model.robots.values():
            for verb in device.kind.verbs.values() if isinstance(device, Device) else ():
                if verb.answers:
                    assert tried(folder, device.name, verb.answers) == set(verb.answers)


@pytest.mark.sampled(16)
@pytest.mark.parametrize("case", CASES, ids=str)
def test_a_task_ends_as_its_recipe_says_whatever_is_answered(case: Case) -> None:
    here = Shop(case)
    state = here.do()
    assert state is (TaskState.FAILED if case.why else TaskState.DONE), here.changes[-1]
    if case.why:
        assert str(here.changes[-1].sentence) == case.why
    assert tuple(here.said[len(here.said) - len(case.ends_with) :]) == case.ends_with
    assert here.wait(60.0, lambda: works(here, case.cell))
    assert here.holding() == []


@pytest.mark.sampled(5)
@pytest.mark.parametrize("case", sample(WITH_DEVICES, every=3), ids=str)
def test_after_any_device_gave_up_the_first_advice_leads_back_to_work(case: Case) -> None:
    whole = Shop(case)
    assert whole.do() is TaskState.DONE
    deeds = {tuple(each.split()) for each in whole.said if each.split()[0] in whole.devices_by_name}
    assert deeds
    for name, verb in sample(sorted(deeds - case.tries_again - case.is_so), every=2):
        here, given_up = Shop(case), []

        def fails(goal: OrderGoal, verb: str = verb, given_up: list[OrderGoal] = given_up) -> str | None:
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


@pytest.mark.sampled(4)
@pytest.mark.parametrize("case", sample(PLAIN, every=4), ids=str)
def test_after_a_stop_at_any_time_the_first_advice_leads_back_to_work(case: Case) -> None:
    whole = Shop(case)
    assert whole.do() is TaskState.DONE
    for count in range(1, len(whole.said), length(8, whole=4)):
        here = Shop(case)
        here.submit(case.task)
        assert here.wait(200.0, lambda here=here, count=count: len(here.said) >= count)
        assert here.operate(Verb.STOP) is None
        here.wait(1.0)
        done = [each for cell in here.plant.cells for each in follow(here, cell)]
        assert here.holding() == [], (here.said[-1], done)
        assert here.do() is TaskState.DONE, (done, here.changes[-1])


@pytest.mark.parametrize("folder", [each for each in FOLDERS if each != "own_tree"])
def test_recipes_import_nothing_else_of_arboleda_than_what_is_public(folder: str) -> None:
    files = list((EXAMPLES / folder).glob("**/*.py"))
    assert files
    for file in files:
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if isinstance(node, ast.Import):
                assert not [each.name for each in node.names if each.name.split(".")[0] == "arboleda"]
            elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "arboleda":
                assert {each.name for each in node.names} <= set(PUBLIC[node.module or ""])


def arms(folder: str) -> list[Workspace]:
    """The workspaces of all arms of an example."""
    spaces = [space for cell in load(folder).cells for space in cell.spaces]
    return [space for space in spaces if isinstance(space.robot, Arm)]


def test_the_examples_with_arms_that_reach_targets_are_these() -> None:
    assert [each for each in FOLDERS if arms(each)] == list(WITH_ARMS)


@pytest.mark.parametrize("folder", WITH_ARMS)
def test_a_target_is_the_same_place_for_all_arms_and_another_one_than_the_others(folder: str) -> None:
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


@pytest.mark.parametrize("page", sorted(PAGES.glob("*.md")), ids=lambda page: page.name)
def test_a_page_shows_tasks_that_its_example_takes(page: Path) -> None:
    folder = page.name.partition(".")[0]
    tasks = re.findall(r'arboleda (?:up|tree) "(.+)" --plant (\S+)', page.read_text("utf-8"))
    assert {file for _, file in tasks} == {f"examples/{folder}/plant.yaml"}
    for task, _ in tasks:
        assert parse(task, load(folder)).text.split()[0] in [cell.name for cell in load(folder).cells]


@pytest.mark.parametrize("folder", SHOWN)
def test_an_example_has_a_page_in_both_languages_with_its_tree_and_a_picture(folder: str) -> None:
    for name in (f"{folder}.md", f"{folder}.es.md"):
        text = (PAGES / name).read_text("utf-8")
        assert "![" in text and f"../images/examples/{folder}.png" in text
        assert f"../images/examples/{folder}-tree.svg" in text


@pytest.mark.sampled(4)
@pytest.mark.parametrize("folder", SHOWN)
def test_the_picture_of_a_tree_is_the_tree_as_it_is(folder: str) -> None:
    page = (PAGES / f"{folder}.md").read_text("utf-8")
    (task,) = set(re.findall(r'arboleda tree "(.+)" --plant', page))
    drawn = CliRunner().invoke(
        cli, ["tree", task, "--plant", str(EXAMPLES / folder / "plant.yaml"), "--format", "svg"]
    )
    picture = PAGES.parent / f"images/examples/{folder}-tree.svg"
    assert drawn.output == picture.read_text("utf-8"), "take it anew: make example-pictures"


def test_a_cell_without_the_targets_that_a_recipe_chooses_from_does_not_offer_it() -> None:
    offered = {cell.name: [recipe.name for recipe in cell.recipes] for cell in load("kitting").cells}
    assert offered == {"kitting": ["kit", "wave"], "packing": ["collect"]}


def test_no_two_carts_meet_on_their_grid_and_none_is_below_a_lift_that_comes_down() -> None:
    here = Shop(kitting(task=WAVE))
    carts = [robot for robot in here.model.cell("kitting").robots if isinstance(robot, Mobile)]
    platform = here.model.cell("kitting").workspaces["cart_1"].poses[-1].q
    met: list[list[Position | None]] = []
    moved: set[Position | None] = set()

    def look() -> bool:
        at = [here.boards[cart.mqtt].body.true_place for cart in carts]
        met.extend([at] if len(set(at)) < len(at) else [])
        moved.update(at)
        work = here.plant.dispatcher.ledger.work_of("lift")
        if work is not None and isinstance(work.command, MotionCall) and platform in at:
            met.append(at)
        return here.changes[-1].state in ENDED

    here.submit(WAVE)
    while not look():
        here.wait(0.05)
    assert here.changes[-1].state is TaskState.DONE
    assert platform in moved and len(moved) > len(carts)
    assert met == []


def test_the_other_cell_gets_the_lift_between_two_carts() -> None:
    here = Shop(kitting(task=WAVE))
    here.submit(WAVE)
    assert here.wait(60.0, lambda: here.plant.zones.holder("lift") == "kitting")
    here.submit(COLLECT)
    holders: list[str | None] = []
    while here.plant.cells["kitting"].task is not None:
        here.wait(0.1)
        holders.append(here.plant.zones.holder("lift"))
    order = [name for name, _ in groupby(each for each in holders if each)]
    assert order == ["kitting", "packing", "kitting"], order
