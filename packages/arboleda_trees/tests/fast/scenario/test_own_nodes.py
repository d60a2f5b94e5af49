"""Nodes of trees in Python, as the how-to shows them: checked, run, kept when killed, and when they raise."""

from __future__ import annotations

import re
from pathlib import Path
from shutil import copytree

import pytest
from tests.scenario.restarts import ENDED, restart

from arboleda.model.errors import ConfigError
from arboleda.model.messages import Reason, TaskState
from arboleda.plant_file.loader import load
from arboleda.testing import Rig
from arboleda_trees.bt_xml.nodes import Category
from arboleda_trees.commands import nodes

ROOT = Path(__file__).parents[5]
PAGE = (ROOT / "docs/how-to/trees-as-xml.md").read_text("utf-8")
SHOWN = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)[0]
CATEGORIES = {
    "BehindClosedDoor": Category.DECORATOR,
    "OneOf": Category.CONTROL,
    "Machine": Category.ACTION,
    "GripForce": Category.ACTION,
    "IsHeavy": Category.CONDITION,
}


def plant(folder: Path, body: str, python: str = SHOWN) -> Path:
    """A plant with a tree of this body, and these nodes."""
    copytree(ROOT / "examples/own_tree", folder, dirs_exist_ok=True)
    file = folder / "plant.yaml"
    file.write_text(file.read_text().replace("[tend.xml]", "[tend.xml, nodes.py]"))
    (folder / "nodes.py").write_text(python)
    tree = f'<BehaviorTree ID="T">\n<Sequence>{body}</Sequence></BehaviorTree>'
    (folder / "tend.xml").write_text(f'<root BTCPP_format="4">\n{tree}</root>')
    return file


def begun(folder: Path, body: str, python: str = SHOWN) -> Rig:
    rig = Rig(load(plant(folder, body, python)))
    rig.wait(5.0)
    rig.submit("cell tend #one")
    return rig


def ended(rig: Rig, at_most_s: float = 90.0) -> TaskState:
    rig.wait(at_most_s, until=lambda: rig.outcomes()["one"].state in ENDED)
    return rig.outcomes()["one"].state


def fact(rig: Rig, name: str) -> object:
    return rig.plant.dispatcher.beliefs["mill"].facts.get(name)


def problems(folder: Path, body: str, python: str = SHOWN) -> str:
    with pytest.raises(ConfigError) as refused:
        load(plant(folder, body, python))
    return "\n".join(refused.value.problems)


def test_they_are_in_the_palette_with_their_category(tmp_path: Path) -> None:
    kinds = nodes.of_plant(load(plant(tmp_path, "<mill_open/>")), None)
    assert {name: kinds[name].category for name in CATEGORIES} == CATEGORIES
    assert (kinds["OneOf"].fewest, kinds["OneOf"].most) == (2, 3)
    margin = (kinds["GripForce"].ports or {})["margin"]
    assert (margin.type, margin.default, margin.limits) == ("int", "2", (1, 5))


ANY = "<IsHeavy grams='900'/>"
ALL = (
    '<Script code="g := 2000"/><GripForce grams="{g}" margin="1" force="{f}"/>'
    '<ScriptCondition code="f &gt; 19.6 &amp;&amp; f &lt; 19.7"/><jaw_close width_mm="30" force_n="{f}"/>'
    '<mill_clamp on="true"/><BehindClosedDoor><OneOf tries="2"><IsHeavy grams="100"/><mill_says door="open"/>'
    '<mill_run program="1001"/></OneOf></BehindClosedDoor><mill_says door="open"/><Machine program="1002"/>'
)


def test_the_nodes_of_the_page_do_their_work(tmp_path: Path) -> None:
    rig = begun(tmp_path, ALL)
    assert ended(rig) is TaskState.DONE, rig.outcomes()["one"]
    assert fact(rig, "door") == "open"


@pytest.mark.sampled(4)
@pytest.mark.parametrize("at_s", [6.0, 12.0, 30.0, 38.0])
def test_a_plant_that_is_killed_goes_on_in_them(tmp_path: Path, at_s: float) -> None:
    rig = begun(tmp_path, ALL)
    rig.wait(at_s)
    assert rig.outcomes()["one"].state is TaskState.RUNNING
    restart(rig, after_s=1.5)
    for _ in range(60):
        rig.wait(2.0, until=lambda: rig.outcomes()["one"].state in ENDED)
        for first in rig.plant.advice("cell")[:1]:
            rig.operate(first.do, first.scope)
    assert ended(rig) is TaskState.DONE, rig.outcomes()["one"]


NONE = '<OneOf><IsHeavy grams="1"/><mill_says door="open"/></OneOf>'


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("body", "state"),
    [
        (NONE, TaskState.FAILED),
        (f"<Fallback>{NONE}<mill_open/></Fallback>", TaskState.DONE),
        ('<Inverter><IsHeavy grams="1"/></Inverter>', TaskState.DONE),
        (f'<Repeat num_cycles="3"><OneOf><IsHeavy grams="1"/>{ANY}</OneOf></Repeat>', TaskState.DONE),
        (f"<OneOf>{ANY}<ForceFailure><OneOf>{ANY}{ANY}</OneOf></ForceFailure></OneOf>", TaskState.DONE),
    ],
)
def test_a_failure_below_them_is_answered_by_whoever_can(tmp_path: Path, body: str, state: TaskState) -> None:
    rig = begun(tmp_path, f"<mill_close/>{body}")
    assert ended(rig) is state, rig.outcomes()["one"]


def test_a_child_that_fails_is_tried_again_by_a_step_around_it(tmp_path: Path) -> None:
    """The door opens beside it, between two tries."""
    tries = '<OneOf tries="5"><IsHeavy grams="1"/><mill_says door="open"/></OneOf>'
    opens = '<Delay delay_msec="1500"><mill_open/></Delay>'
    rig = begun(tmp_path, f'<mill_close/><Parallel success_count="2">{tries}{opens}</Parallel>')
    assert ended(rig) is TaskState.DONE, rig.outcomes()["one"]


RAISES = """from arboleda.recipes import function, node
@function("Adds", gives={"sum": float})
def adds(one: float):
    return {"sum": 1 / one}
@function("Says")
def says(one: float):
    return one
@function("Text", gives={"sum": float})
def text(one: float):
    return {"sum": "much"}
"""


@pytest.mark.parametrize(
    ("body", "why"),
    [
        ('<Adds one="0" sum="{s}"/>', "Adds raised ZeroDivisionError: "),
        ('<Says one="1"/>', "Says returned 1.0; it is to return True or False"),
        ('<Text one="1" sum="{s}"/>', "sum of Text became 'much'; it is to be a float"),
    ],
)
def test_what_they_raise_is_an_error_of_the_plant(tmp_path: Path, body: str, why: str) -> None:
    rig = begun(tmp_path, f"<mill_close/>{body}", RAISES)
    assert ended(rig) is TaskState.FAILED
    assert why in str(rig.outcomes()["one"].sentence)
    assert rig.outcomes()["one"].reason is Reason.INTERNAL


WRONG = {
    "<BehindClosedDoor/>": "tend.xml:3:11: BehindClosedDoor has no children; it needs 1",
    "<OneOf><mill_open/></OneOf>": "OneOf has 1 child; it needs 2 to 3",
    "<Machine/>": "Machine needs program: a whole number, or a variable",
    '<Machine program="7"/>': "program of Machine is '7'; there are 1001, 1002",
    '<GripForce grams="1" margn="2"/>': "did you mean margin?",
    '<GripForce grams="much"/>': "grams of GripForce must be a number, is 'much'",
}


def test_ports_and_children_of_the_tree_are_checked(tmp_path: Path) -> None:
    told = problems(tmp_path, "".join(WRONG))
    assert [each for each in WRONG.values() if each not in told] == []


HEAD = "from arboleda.recipes import node\n"
EMPTY = "def mine(cell):\n    pass\n"
NO_STEP = f'{HEAD}@node("Mine")\ndef mine(cell):\n    return 7\n'
LEFT_OUT = f'{HEAD}@node("Mine")\ndef mine(cell, child):\n    return cell.device("mill").open()\n'
NO_ROLE = f'{HEAD}@node("Mine")\ndef mine(cell):\n    return cell.device("mil").open()\n'
NO_TYPE = f'{HEAD}@node("Mine")\ndef mine(cell, what):\n    pass\n'
LATE = '<Script code="p := 1001"/><Machine program="{p}"/>'


@pytest.mark.sampled(5)
@pytest.mark.parametrize(
    ("body", "python", "said"),
    [
        (LATE, SHOWN, "program of Machine is '{p}', which is known only"),
        ("<BehindClosedDor><mill_open/></BehindClosedDor>", SHOWN, "did you mean BehindClosedDoor?"),
        ('<Decorator ID="Zip"><mill_open/></Decorator>', SHOWN, 'write it in Python: @node("Zip")'),
        ("<Mine/>", NO_STEP, "Mine returns 7; a node returns a step"),
        ("<Mine><mill_open/></Mine>", LEFT_OUT, "one of its children is not"),
        ("<Mine/>", NO_ROLE, "nodes.py:4:1: tend: cell has no device in the role 'mil'"),
        ("<mill_open/>", NO_TYPE, "what needs what it can be"),
        ("<mill_open/>", f'{HEAD}@node("Sequence")\n{EMPTY}', "comes with BehaviorTree.CPP"),
        ("<mill_open/>", f'{HEAD}@node("my node")\n{EMPTY}', "cannot be the name of a node"),
        ("<mill_open/>", f'{HEAD}@node("mill_open")\n{EMPTY}', "rename that in Python"),
        ("<mill_open/>", f'{HEAD}@node("A")\n{EMPTY}@node("A")\n{EMPTY}', "Python forgets that on line 3"),
    ],
)
def test_what_is_wrong_with_them_is_told_before_anything_runs(
    tmp_path: Path, body: str, python: str, said: str
) -> None:
    assert said in problems(tmp_path, body, python)
