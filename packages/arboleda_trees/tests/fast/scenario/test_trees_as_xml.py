"""A recipe that is a tree of a file: it runs, is kept through a crash, and says what it cannot do."""

from __future__ import annotations

from pathlib import Path
from shutil import copytree

import pytest
from tests.lengths import sample
from tests.scenario.restarts import ENDED, restart

from arboleda.core import reasons
from arboleda.core.plant import Plant
from arboleda.model.messages import TaskState, Verb
from arboleda.model.recipe import Limits
from arboleda.model.text import parse
from arboleda.plant_file.loader import load
from arboleda.testing import Rig
from arboleda.trees.leaves import title_of
from arboleda.views import view
from arboleda_trees.bt_xml.parameters import LARGEST

EXAMPLE = Path(__file__).parents[5] / "examples" / "own_tree" / "plant.yaml"
TASK = "cell tend slot_1 1001 #one"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    copytree(EXAMPLE.parent, tmp_path, dirs_exist_ok=True)
    return tmp_path


def state(rig: Rig) -> TaskState:
    return rig.outcomes()["one"].state


def attended(rig: Rig, at_most_s: float = 200.0) -> None:
    """Somebody answers, and does what is advised first, until the task has ended."""
    for _ in range(int(at_most_s / 2)):
        if rig.wait(2.0, until=lambda: state(rig) in ENDED):
            return
        if rig.plant.dispatcher.ledger.question("operator") is not None:
            rig.operate(Verb.ANSWER, "operator", answer="good")
        for first in rig.plant.advice("cell")[:1]:
            if isinstance(first.do, Verb):
                rig.operate(first.do, first.scope)


def begin(file: Path = EXAMPLE) -> Rig:
    rig = Rig(load(file))
    rig.wait(5.0)
    rig.submit(TASK)
    return rig


def test_a_tree_of_a_file_is_a_recipe_with_its_ports_as_parameters() -> None:
    (recipe,) = load(EXAMPLE).cells[0].recipes
    (cell,) = load(EXAMPLE).cells
    assert [each.name for each in recipe.parameters] == ["blank", "program"]
    assert list(recipe.parameters[1].words(cell)) == ["1001", "1002"]


def test_it_does_its_work() -> None:
    rig = begin()
    attended(rig)
    assert state(rig) is TaskState.DONE, rig.outcomes()["one"]


@pytest.mark.sampled(6)
@pytest.mark.parametrize(
    "at_s", sample([0.5, 3.0, 6.0, 9.0, 12.0, 15.0, 30.0, 35.0, 38.0, 40.0, 43.0], every=2)
)
def test_it_goes_on_whenever_the_plant_is_killed(at_s: float) -> None:
    rig = begin()
    rig.wait(at_s)
    assert state(rig) is TaskState.RUNNING
    restart(rig, after_s=1.5)
    attended(rig)
    assert state(rig) is TaskState.DONE, rig.outcomes()["one"]


def test_a_tree_that_was_changed_is_not_walked_into(folder: Path) -> None:
    rig = begin(folder / "plant.yaml")
    rig.wait(9.0)
    tree = folder / "tend.xml"
    tree.write_text(tree.read_text().replace('num_attempts="2"', 'num_attempts="3"'))
    restart(rig, load(folder / "plant.yaml"), after_s=1.0)
    rig.wait(1.0)
    assert "its recipe or the plant file has changed" in str(reasons.of_hold(rig.plant.cells["cell"]))


def test_screens_see_its_variables(folder: Path) -> None:
    body = "<Sequence><Script code=\"count := 2; said := 'yes'\"/><mill_open/></Sequence>"
    (folder / "tend.xml").write_text(
        f'<root BTCPP_format="4"><BehaviorTree ID="T">{body}</BehaviorTree></root>'
    )
    rig = Rig(load(folder / "plant.yaml"))
    rig.wait(5.0)
    rig.submit("cell tend #one")
    rig.wait(1.0)
    (cell,) = view.snapshot(rig.plant)["cells"]
    assert {"count": "2", "said": "yes"} in [row["parameters"] for row in cell["tree"]]


LOOP = '<Repeat num_cycles="300"><Script code="n := 1"/></Repeat>'
SKIPS = (
    '<Parallel success_count="2" failure_count="2"><AlwaysSuccess/>'
    '<AlwaysSuccess _skipIf="true"/><Sleep msec="500"/></Parallel>'
)
UNNAMED = '<ScriptCondition code="1 == 2"/>'
EMPTY = UNNAMED.replace("code", 'name="not empty" code')
EMPTY_TOO = EMPTY.replace("empty", "full")
FAILS = '<ScriptCondition code="1 / 0 == 1"/>'
MORE = (
    '<Script code="most := 3"/><ParallelAll max_failures="{most}"><mill_open/><AlwaysSuccess/></ParallelAll>'
)
MORE_PARALLEL = MORE.replace("All max_failures", " success_count").replace("All>", ">")


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("body", "ends", "why"),
    [
        (LOOP, TaskState.DONE, ""),
        (SKIPS, TaskState.DONE, ""),
        (FAILS, TaskState.FAILED, "a division by zero"),
        (MORE, TaskState.FAILED, "max_failures of ParallelAll is 3, and it has 2 children"),
        (MORE_PARALLEL, TaskState.FAILED, "success_count of Parallel is 3, and it has 2 children"),
        ("<AlwaysFailure/>", TaskState.FAILED, "the tree tend has failed"),
        ('<AlwaysFailure name="no plate"/>', TaskState.FAILED, "the tree tend has failed: no plate"),
        ('<AlwaysFailure _description="no lid"/>', TaskState.FAILED, "the tree tend has failed: no lid"),
        (EMPTY, TaskState.FAILED, "the tree tend has failed: not empty"),
        (f"<Fallback>{EMPTY}{EMPTY_TOO}</Fallback>", TaskState.FAILED, "the tree tend has failed: not full"),
        (f"<Fallback>{EMPTY}<AlwaysFailure/></Fallback>", TaskState.FAILED, "the tree tend has failed"),
        (
            f"<Fallback>{EMPTY}<AlwaysSuccess/></Fallback>{UNNAMED}",
            TaskState.FAILED,
            "the tree tend has failed",
        ),
        (
            f"<Fallback>{EMPTY}<AlwaysSuccess/></Fallback><Inverter><AlwaysSuccess/></Inverter>",
            TaskState.FAILED,
            "the tree tend has failed",
        ),
        (
            f"<TryCatch>{EMPTY}{EMPTY_TOO}</TryCatch>",
            TaskState.FAILED,
            "the tree TryCatch has failed: not empty",
        ),
    ],
)
def test_what_takes_no_time_ends(folder: Path, body: str, ends: TaskState, why: str) -> None:
    tree = f'<BehaviorTree ID="T"><Sequence><mill_open/>{body}</Sequence></BehaviorTree>'
    (folder / "tend.xml").write_text(f'<root BTCPP_format="4">{tree}</root>')
    rig = Rig(load(folder / "plant.yaml"))
    rig.wait(5.0)
    rig.submit("cell tend #one")
    rig.wait(30.0, until=lambda: state(rig) in ENDED)
    assert state(rig) is ends
    assert str(rig.outcomes()["one"].sentence or "") == why


ANSWERED = '<Fallback><mill_says door="closed"/><AlwaysSuccess/></Fallback>'
CONDITION = '<ScriptCondition code="1 == 2"/>'
UNANSWERED = "door"  # a word of the sentence with which the condition above fails


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("body", "is_named"),
    [
        (ANSWERED + CONDITION, False),
        (f"<Fallback>{ANSWERED.replace('AlwaysSuccess', 'AlwaysFailure')}{CONDITION}</Fallback>", True),
        (f'<Fallback><mill_says door="closed"/><Sequence>{ANSWERED}{CONDITION}</Sequence></Fallback>', True),
        (
            f'<Parallel failure_count="2"><mill_says door="closed"/><Sequence><Sleep msec="50"/>'
            f"<Sequence><AlwaysSuccess/></Sequence>{CONDITION}</Sequence></Parallel>",
            True,
        ),
        (
            '<RetryUntilSuccessful num_attempts="2"><Sequence><Inverter>'
            f'<mill_says door="closed"/></Inverter>{CONDITION}</Sequence></RetryUntilSuccessful>',
            False,
        ),
    ],
    ids=["in the row before", "not answered", "answered after it", "beside it", "inverted"],
)
def test_a_condition_fails_a_tree_without_a_failure_that_was_answered(
    folder: Path, body: str, is_named: bool
) -> None:
    rig = ran(folder, "<mill_open/>" + body)
    said = str(rig.outcomes()["one"].sentence)
    assert state(rig) is TaskState.FAILED
    assert (UNANSWERED in said) is is_named and (said == "the tree tend has failed") is not is_named


def ran(
    folder: Path, body: str, task: str = "cell tend #one", ports: str = "", at_most_s: float = 60.0
) -> Rig:
    """A tree of this body, run to its end, or so long."""
    tree = f'<BehaviorTree ID="T"><Sequence>{body}</Sequence></BehaviorTree>'
    models = f'<TreeNodesModel><SubTree ID="T">{ports}</SubTree></TreeNodesModel>'
    (folder / "tend.xml").write_text(f'<root BTCPP_format="4" main_tree_to_execute="T">{tree}{models}</root>')
    rig = Rig(load(folder / "plant.yaml"))
    rig.wait(5.0)
    rig.submit(task)
    rig.wait(at_most_s, until=lambda: state(rig) in ENDED)
    return rig


def said(rig: Rig, fact: str, robot: str = "mill") -> object:
    return dict(rig.plant.dispatcher.beliefs[robot].facts)[fact]


CLAMPS = '<mill_clamp on="{on}"/>'
SET, UNCLAMPED = '<Script code="on := true"/>', '<Script code="on := 0"/>'
CLAMPED = f"{SET}{CLAMPS}"


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("body", "clamped"),
    [
        (CLAMPED, True),
        (f"{UNCLAMPED}{CLAMPS}", False),
        (f'{CLAMPED}<Script code="on := on == 0"/>{CLAMPS}', False),
        (f'{CLAMPED}<mill_tells clamped="{{is}}"/><Script code="on := !is"/>{CLAMPS}', False),
        (f'<mill_tells door="{{d}}"/><Script code="on := d == \'open\'"/>{CLAMPS}', True),
        (f'{UNCLAMPED}<Repeat num_cycles="2"><Sequence>{CLAMPS}{SET}</Sequence></Repeat>', True),
    ],
)  # fmt: skip
def test_what_a_device_is_told_may_be_known_only_then(folder: Path, body: str, clamped: bool) -> None:
    rig = ran(folder, body)
    assert state(rig) is TaskState.DONE, rig.outcomes()["one"]
    assert said(rig, "clamped") is clamped


@pytest.mark.sampled(4)
@pytest.mark.parametrize("at_s", [1.0, 4.0, 12.0, 24.0])
def test_values_of_variables_are_kept_with_the_step_that_was_given_them(folder: Path, at_s: float) -> None:
    run = '<Script code="p := 1002"/><mill_run program="{p}"/>'
    body = f"{SET}<mill_close/>{CLAMPS}{run}{UNCLAMPED}{CLAMPS}<mill_open/>"
    rig = ran(folder, body, at_most_s=at_s)
    assert state(rig) is TaskState.RUNNING
    restart(rig, after_s=1.5)
    attended(rig)
    assert state(rig) is TaskState.DONE, rig.outcomes()["one"]
    assert said(rig, "clamped") is False


def test_a_picture_names_the_variables_that_have_no_value_yet(folder: Path) -> None:
    body = f'<Script code="on := 1"/>{CLAMPS}<jaw_close width_mm="{{width}}" force_n="4"/>'
    rig = ran(folder, body, "cell tend 33 #one", '<input_port name="width" type="double"/>')
    model = rig.plant.model
    recipe = model.cells[0].recipe("tend")
    order = parse("cell tend 33", model)
    tree = recipe.build(order, Plant(model, epoch=0, now=0.0).cells["cell"].context)
    titles = [str(title_of(node)) for node in tree.iterate()]
    assert "mill clamp {on}" in titles and "jaw close 33.0 4.0" in titles


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("body", "why"),
    [
        ('<Script code="w := 300"/><jaw_close width_mm="{w}" force_n="4"/>',
         "width_mm of jaw_close must be from 0 to 85, is '300'"),
        ("<Script code=\"w := 'wide'\"/><jaw_close width_mm=\"{w}\" force_n=\"4\"/>",
         "width_mm of jaw_close must be a number, is 'wide'"),
        ('<Script code="p := 1003"/><mill_run program="{p}"/>', "program of mill_run is '1003'; there are"),
        ('<Script code="p := 1"/><UnsetBlackboard key="p"/><mill_run program="{p}"/>',
         "program of mill_run is the variable p, which has no value"),
    ],
)  # fmt: skip
def test_a_value_that_a_device_does_not_take_fails_the_task(folder: Path, body: str, why: str) -> None:
    rig = ran(folder, body)
    assert state(rig) is TaskState.FAILED
    assert why in str(rig.outcomes()["one"].sentence)


def test_a_parameter_may_be_a_number(folder: Path) -> None:
    ports = '<input_port name="width" type="double"/><input_port name="times" type="int"/>'
    body = (
        '<jaw_close width_mm="{width}" force_n="40"/><Repeat num_cycles="{times}"><mill_open/></Repeat>'
        '<ScriptCondition code="width + times == 35.5"/>'
    )
    rig = ran(folder, body, "cell tend 33.5 times=2 #one", ports)
    assert state(rig) is TaskState.DONE, rig.outcomes()["one"]
    assert rig.submit("cell tend 90 2").state is TaskState.REFUSED
    width, times = load(folder / "plant.yaml").cells[0].recipes[0].parameters
    (cell,) = load(folder / "plant.yaml").cells
    assert width.limits(cell) == Limits(lower=0.0, upper=85.0)
    assert times.limits(cell) == Limits(lower=-LARGEST, upper=LARGEST, whole=True)


GRIP = (
    '<BehaviorTree ID="Grip"><jaw_close width_mm="{width}" force_n="{force}"/></BehaviorTree>'
    '<TreeNodesModel><SubTree ID="T"><input_port name="force" type="double"/></SubTree></TreeNodesModel>'
)


@pytest.mark.sampled(2)
@pytest.mark.parametrize(("given", "width"), [("20", 20.0), ("{=}", 80.0), ("{other}", 30.0)])
def test_a_subtree_that_shares_names_is_told_what_it_is_given(folder: Path, given: str, width: float) -> None:
    sub = f'<SubTree ID="Grip" width="{given}" _autoremap="true"/>'
    body = f'<Script code="width := 80; other := 30"/>{sub}'
    file = f'<root BTCPP_format="4" main_tree_to_execute="T"><BehaviorTree ID="T"><Sequence>{body}'
    (folder / "tend.xml").write_text(f"{file}</Sequence></BehaviorTree>{GRIP}</root>")
    rig = Rig(load(folder / "plant.yaml"))
    rig.wait(5.0)
    assert rig.submit("cell tend 1000 #much").state is TaskState.REFUSED, "the jaw takes no such force"
    rig.submit("cell tend 40 #one")
    rig.wait(30.0, until=lambda: state(rig) in ENDED)
    assert state(rig) is TaskState.DONE, rig.outcomes()["one"]
    assert said(rig, "width_mm", "jaw") == width
