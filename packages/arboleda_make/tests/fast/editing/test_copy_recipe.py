"""Recipes in Python as trees: what can be said in XML does the same, what cannot is refused by its step."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from tests.lengths import length

from arboleda.model.plant_model import PlantModel
from arboleda.model.recipe import Recipe
from arboleda.plant_file.loader import load
from arboleda.recipes.of_files import FileRecipe
from arboleda_drawn.forms import differences_of
from arboleda_make.editing import desk
from arboleda_make.editing.errors import EditError

EXAMPLES = Path(__file__).parents[5] / "examples"
COPIED = {
    "agv": ["fetch"],
    "assembly": ["assemble"],
    "lab_bench": ["weigh", "incubate"],
    "mixed": ["deliver"],
    "own_board": ["fill"],
    "own_driver": ["form"],
    "plc_conveyor": ["pass"],
    "press_board": ["stamp"],
}
PLANT = """name: lab
uses: [recipes.py]
kinds:
  pump:
    verbs:
      pump: {effect: process, with: {ml: number}, takes_s: 1}
      look: {effect: query, answers: [a, b, c, d, e, f, g], takes_s: 1}
      see: {effect: query, answers: [a, b], takes_s: 1}
      level: {effect: query, answers: ["> 5", otherwise], takes_s: 1}
      weigh: {effect: query, answers: number, takes_s: 1}
cells:
  lab:
    devices: {arm: {kind: arm, model: scara}, pump_1: {kind: pump}, pump_2: {kind: pump}}
    groups: {slots: [feed, tray]}
    targets:
      home: {arm: {deg: [0, 0], mm: 0}}
      feed: {arm: {deg: [60, 20], mm: 80}}
      tray: {arm: {deg: [-45, 20], mm: 80}}
"""
HEAD = "from arboleda.recipes import Choice, Number, Target, parallel, recipe, work\n\n\n@recipe('a')\n"
Lab = Callable[[str], PlantModel]


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    """`lab("def a(cell): ...")`: a laboratory with an arm and two pumps, and this recipe."""

    def made(code: str) -> PlantModel:
        (tmp_path / "plant.yaml").write_text(PLANT)
        (tmp_path / "recipes.py").write_text(HEAD + code)
        return load(tmp_path / "plant.yaml")

    return made


def copied(model: PlantModel) -> str:
    """The body of the tree, on one line."""
    text = desk.copied(model, "lab", "a", "b")
    assert [each["sentence"] for each in desk.drawn(model, "lab", text)["marks"]] == []
    body = text[text.index(">", text.index("<BehaviorTree")) + 1 : text.index("</BehaviorTree>")]
    return re.sub(r"\s*\n\s*", "", body)


def only(model: PlantModel, recipe: Recipe) -> PlantModel:
    """The plant with this recipe alone, in its first cell."""
    first, *others = model.cells
    cells = (replace(first, recipes=(recipe,)), *(replace(each, recipes=()) for each in others))
    return replace(model, cells=cells)


@pytest.mark.sampled(8)
@pytest.mark.parametrize("name", COPIED)
def test_the_copy_is_accepted_by_check_and_tells_devices_the_same(name: str, tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLES / name, tmp_path / name)
    plant = folder / "plant.yaml"
    model = load(plant)
    copies = {recipe: f"{recipe}_tree" for recipe in COPIED[name]}
    for recipe, copy in copies.items():
        (folder / f"{copy}.xml").write_text(desk.copied(model, model.cells[0].name, recipe, copy))
    files = ", ".join(f"{copy}.xml" for copy in copies.values())
    plant.write_text(plant.read_text().replace("uses: [recipes.py", f"uses: [recipes.py, {files}"))
    both = load(plant)
    for recipe, copy in copies.items():
        python, tree = both.cells[0].recipe(recipe), both.cells[0].recipe(copy)
        assert isinstance(tree, FileRecipe) and (tree.about, tree.ends_with) == (
            python.about,
            python.ends_with,
        )
        for seed in length((1,), whole=(1, 2, 3)):
            found = differences_of(only(both, python), only(both, replace(tree, name=recipe)), seed)
            assert found == []


@pytest.mark.parametrize(
    ("name", "recipe", "why"),
    [
        ("machine_tending", "mill", "tender.brings_back_to cannot be drawn: no node in XML does this"),
        ("kitting", "kit", "using(lift) cannot be drawn: lift is shared with other cells"),
    ],
)
def test_what_no_tree_says_is_refused_by_the_step_and_why(name: str, recipe: str, why: str) -> None:
    model = load(EXAMPLES / name / "plant.yaml")
    with pytest.raises(EditError, match=re.escape(why)):
        desk.copied(model, model.cells[0].name, recipe, "copy")


def test_a_value_that_is_given_as_it_is_stays_a_parameter(lab: Lab) -> None:
    model = lab("def a(cell, ml=Choice(5, 10)):\n    return cell.device('pump_1').pump(ml)\n")
    assert copied(model) == '<pump_1_pump ml="{ml}"/>'
    assert '<Metadata values="ml: 5, 10"/>' in desk.copied(model, "lab", "a", "b")


def test_a_listed_answer_that_reads_like_a_range_is_a_case_of_a_switch(lab: Lab) -> None:
    code = "def a(cell):\n    seen = cell.device('pump_1').level()\n"
    code += "    ways = {'> 5': cell.wait(1), 'otherwise': cell.wait(2)}\n"
    drawn = copied(lab(code + "    return work(seen, cell.choose(seen, ways))\n"))
    assert 'case_1="&gt; 5" case_2="otherwise"' in drawn


def test_where_a_parameter_chooses_the_device_a_switch_stands_around_that_step_alone(lab: Lab) -> None:
    code = "def a(cell, n=Choice(1, 2), to=Target('slots')):\n"
    code += "    return work(cell.device('arm').go(to), cell.device(f'pump_{n}').pump(ml=7))\n"
    assert copied(lab(code)) == (
        '<Sequence><arm_go target="{to}"/><Switch2 variable="{n}" case_1="1" case_2="2">'
        '<pump_1_pump ml="7"/><pump_2_pump ml="7"/><AlwaysFailure/></Switch2></Sequence>'
    )


def test_the_variable_of_an_answer_is_no_parameter(lab: Lab) -> None:
    code = "def a(cell, answer_1=Choice(5, 10)):\n    pump = cell.device('pump_1')\n    seen = pump.see()\n"
    code += "    ways = {each: pump.pump(answer_1) for each in 'ab'}\n"
    code += "    return work(seen, cell.choose(seen, ways))\n"
    assert copied(lab(code)) == (
        '<Sequence><pump_1_see answer="{answer_2}"/><Switch2 variable="{answer_2}" case_1="a" case_2="b">'
        '<pump_1_pump ml="{answer_1}"/><pump_1_pump ml="{answer_1}"/><AlwaysFailure/></Switch2></Sequence>'
    )


def test_the_steps_around_steps_have_their_nodes(lab: Lab) -> None:
    code = """def a(cell):
    arm, pump = cell.devices('arm', 'pump_1')
    return work(
        cell.retry(pump.pump(1), times=3, pause_s=0.5),
        cell.repeat(cell.timeout(pump.pump(2), 4), 2),
        cell.recover([cell.invert(cell.fallback(pump.pump(3), pump.pump(4)))], []),
        parallel(arm.home(), cell.wait(1.5)),
        arm.visit('feed', arm.grip(), pump.pump(5)),
    )
"""
    assert copied(lab(code)) == (
        '<Sequence><RetryUntilSuccessful num_attempts="4"><Fallback><pump_1_pump ml="1"/><Inverter>'
        '<Sleep msec="500"/></Inverter></Fallback></RetryUntilSuccessful><Repeat num_cycles="2">'
        '<Timeout msec="4000"><pump_1_pump ml="2"/></Timeout></Repeat><TryCatch><Inverter><Fallback>'
        '<pump_1_pump ml="3"/><pump_1_pump ml="4"/></Fallback></Inverter><AlwaysSuccess/></TryCatch>'
        '<Parallel success_count="-1" failure_count="1"><arm_home/><Sleep msec="1500"/></Parallel>'
        '<arm_visit target="feed"><Sequence><arm_grip/><pump_1_pump ml="5"/></Sequence></arm_visit>'
        "</Sequence>"
    )


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("code", "why"),
    [
        (
            "def a(cell, ml=Number(1, 20)):\n    return cell.device('pump_1').pump(ml * 2)\n",
            "pump_1.pump cannot be drawn: it differs with ml in more than a value",
        ),
        (
            "def a(cell, ml=Number(1.0, 20.0)):\n    return cell.device('pump_1').pump(ml)\n",
            "ml cannot be drawn: it is a number from 1 to 20 in a, and would be a number from -1e+09",
        ),
        (
            "def a(cell):\n    return cell.retry(cell.device('pump_1').pump(1), causes=['rejected'])\n",
            "retry cannot be drawn: a node that tries again does so whatever the cause",
        ),
        (
            "def a(cell):\n    seen = cell.device('pump_1').look()\n"
            "    return work(seen, cell.choose(seen, dict.fromkeys('abcdefg', ())))\n",
            "choose of pump_1.look cannot be drawn: it has 7 ways, and a Switch at most 6",
        ),
        (
            "def a(cell):\n    seen = cell.device('pump_1').weigh()\n"
            "    return work(seen, cell.choose(seen, {'> 5': cell.wait(1), 'otherwise': cell.wait(2)}))\n",
            "choose of pump_1.weigh cannot be drawn: its ways are ranges of a number",
        ),
        (
            "def a(cell):\n    return cell.wait(cell.wait(1).seconds)\n",
            "a: AttributeError: 'DrawnStep' object has no attribute 'seconds'",
        ),
        ("def a(cell):\n    return cell.timeout(cell.wait(1), 0)\n", "timeout cannot be drawn: 0 ms"),
        (
            "def a(cell):\n    from py_trees.behaviours import Success\n    return work(Success('mine'))\n",
            "mine cannot be drawn: it is a Success made in Python",
        ),
    ],
)
def test_what_cannot_be_said_is_refused_whole(lab: Lab, code: str, why: str) -> None:
    with pytest.raises(EditError, match=re.escape(why)):
        desk.copied(lab(code), "lab", "a", "b")


@pytest.mark.parametrize(
    ("recipe", "name", "why"),
    [("z", "b", "'z' is no recipe in Python of lab"), ("a", "a", "there is a recipe 'a' already")],
)
def test_only_recipes_that_are_there_are_copied_to_new_names(
    lab: Lab, recipe: str, name: str, why: str
) -> None:
    model = lab("def a(cell):\n    return cell.device('arm').home()\n")
    with pytest.raises(EditError, match=why):
        desk.copied(model, "lab", recipe, name)
