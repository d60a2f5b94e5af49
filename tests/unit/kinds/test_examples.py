"""The examples of cells of devices: whatever is answered or gives up, the cell works again."""

from __future__ import annotations

import ast
import re
from functools import partial
from itertools import groupby
from pathlib import Path

import pytest
from tests.lengths import sample
from typer.testing import CliRunner

import arboleda.drivers
import arboleda.kinds
import arboleda.recipes
from arboleda.cli.main import cli
from arboleda.kinds.declared import MotionCall
from arboleda.kinds.mobile import Mobile
from arboleda.model.commands import Position
from arboleda.model.messages import TaskState
from arboleda.model.text import parse

from . import example_trials
from .example_trials import ENDED, EXAMPLES, OF_DRIVERS, OF_STORAGE, OF_TREES, Case, Shop, arms, load

PAGES = EXAMPLES.parent / "docs/examples"
ALL = sorted({file.parent.name for file in EXAMPLES.glob("*/plant.yaml")} - {OF_STORAGE})
FOLDERS = [folder for folder in ALL if folder not in (*OF_DRIVERS, *OF_TREES)]
OF_HOW_TOS = ("own_board", "own_driver", "press_board")  # their pages are in docs/how-to
SHOWN = [folder for folder in FOLDERS if folder not in OF_HOW_TOS]
WITH_ARMS = ("assembly", "kitting", "machine_tending")
PUBLIC = {each.__name__: each.__all__ for each in (arboleda.drivers, arboleda.kinds, arboleda.recipes)}
BASE, MILL, PALLET = "station assemble base_1 lid_3", "tending mill slot_2 1002", "tending pallet 1001"
SOLD = ("tender to belt", "tender lets go", "tender to home", "belt clear")
KIT, WAVE, COLLECT = "kitting kit 2 tray_4", "kitting wave tray_1", "packing collect"
REJECTED = ("tender to reject", "tender lets go", "tender to home")
bench, tending = partial(Case, folder="lab_bench"), partial(Case, folder="machine_tending")
kitting = partial(Case, folder="kitting")
CASES = (
    Case(folder="assembly", task=BASE, ends_with=("left to done", "left lets go", "left to home")),
    bench(task="bench weigh 10", ends_with=("pump dispense", "scale weigh")),
    bench(
        task="bench weigh 20", answers={"scale": "short"}, why="the scale says that too little was dispensed"
    ),
    bench(task="bench incubate 5 60", ends_with=("heater clamp", "pump rinse")),
    bench(task="bench incubate 5 40", answers={"reader": "blank"}, ends_with=("reader scan", "pump rinse")),
    bench(task="bench incubate 5 40", answers={"reader": "unreadable"}, why="nobody can read the code"),
    tending(task=MILL, ends_with=SOLD),
    tending(task=MILL, answers={"camera": "bad"}, ends_with=REJECTED),
    tending(task=MILL, answers={"camera": "unsure"}, ends_with=SOLD),
    tending(task=MILL, answers={"camera": "unsure", "operator": "bad"}, ends_with=REJECTED),
    Case(folder="own_board", task="bench fill 5", ends_with=("valve dose", "valve close")),
    Case(folder="own_board", task="bench fill 10", answers={"valve": "low"}, why="the tank is low"),
    Case(folder="own_driver", task="shop form 2", ends_with=("press open", "press measure")),
    Case(folder="own_driver", task="shop form 1", answers={"press": "bad"}, why="the part is out of measure"),
    Case(folder="press_board", task="bench stamp 1", ends_with=("press open", "press clamp")),
    Case(folder="press_board", task="bench stamp 2", answers={"press": "absent"}, why="there is no part"),
    tending(task=PALLET, ends_with=SOLD),
    tending(task=PALLET, answers={"operator": "no blanks left"}, why="no blanks are left"),
    kitting(task=KIT, ends_with=("lift roll_in", "cart_2 to home", "lift up", "picker to home")),
    kitting(task=WAVE, ends_with=("lift roll_in", "cart_3 to home", "lift up")),
    kitting(task=COLLECT, ends_with=("lift roll_out", "shuttle to table", "shuttle to home")),
    kitting(task=COLLECT, answers={"lift": "empty"}, why="no kit is on the lift"),
    kitting(task=COLLECT, answers={"packer": "no"}, why="the kit was not packed"),
)
PLAIN = [each for each in CASES if not each.answers and each.task != PALLET]


@pytest.mark.long
def test_every_recipe_of_every_example_and_every_answer_is_tried() -> None:
    assert {case.folder for case in CASES} == set(FOLDERS)
    for folder in FOLDERS:
        example_trials.every_answer_is_tried(folder, CASES)


@pytest.mark.sampled(16)
@pytest.mark.parametrize("case", CASES, ids=str)
def test_a_task_ends_as_its_recipe_says_whatever_is_answered(case: Case) -> None:
    example_trials.ends_as_the_recipe_says(case, CASES)


@pytest.mark.sampled(5)
@pytest.mark.parametrize("case", sample(PLAIN, every=3), ids=str)
def test_after_any_device_gave_up_the_first_advice_leads_back_to_work(case: Case) -> None:
    example_trials.works_again_after_a_device_gave_up(case, CASES)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("case", sample(PLAIN, every=4), ids=str)
def test_after_a_stop_at_any_time_the_first_advice_leads_back_to_work(case: Case) -> None:
    example_trials.works_again_after_a_stop(case, CASES)


@pytest.mark.parametrize("folder", [each for each in ALL if each not in OF_TREES])
def test_recipes_import_nothing_else_of_arboleda_than_what_is_public(folder: str) -> None:
    files = list((EXAMPLES / folder).glob("**/*.py"))
    assert files
    for file in files:
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if isinstance(node, ast.Import):
                assert not [each.name for each in node.names if each.name.split(".")[0] == "arboleda"]
            elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "arboleda":
                assert {each.name for each in node.names} <= set(PUBLIC[node.module or ""])


def test_the_examples_with_arms_that_reach_targets_are_these() -> None:
    assert [each for each in FOLDERS if arms(each)] == list(WITH_ARMS)


@pytest.mark.parametrize("folder", WITH_ARMS)
def test_a_target_is_the_same_place_for_all_arms_and_another_one_than_the_others(folder: str) -> None:
    example_trials.targets_are_places_of_their_own(folder)


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
    here = Shop(kitting(task=WAVE), CASES)
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
    here = Shop(kitting(task=WAVE), CASES)
    here.submit(WAVE)
    assert here.wait(60.0, lambda: here.plant.zones.holder("lift") == "kitting")
    here.submit(COLLECT)
    holders: list[str | None] = []
    while here.plant.cells["kitting"].task is not None:
        here.wait(0.1)
        holders.append(here.plant.zones.holder("lift"))
    order = [name for name, _ in groupby(each for each in holders if each)]
    assert order == ["kitting", "packing", "kitting"], order
