"""A tree that cannot be run is refused with the plant file, with its place and what to take instead."""

from __future__ import annotations

from pathlib import Path
from shutil import copytree

import pytest

from arboleda.model.errors import ConfigError
from arboleda.plant_file.loader import load
from arboleda_trees.bt_xml.nodes import BUILT_IN
from arboleda_trees.bt_xml.runnable import INSTEAD
from arboleda_trees.bt_xml.running.build import MAKERS

EXAMPLE = Path(__file__).parents[5] / "examples" / "own_tree"
PAGE = Path(__file__).parents[5] / "docs/reference/bt-xml.md"
CLOSE = "<mill_close/>"
AT_CLOSE = "11:7: "
WRONG = (
    (CLOSE, f"<ManualSelector>{CLOSE}</ManualSelector>", AT_CLOSE + "ManualSelector can be drawn and not be"),
    (
        CLOSE,
        f'<TryCatch catch_on_halt="true">{CLOSE}{CLOSE}</TryCatch>',
        "11:17: catch_on_halt of TryCatch must",
    ),
    (CLOSE, "<mill_clos/>", "did you mean mill_close?"),
    (CLOSE, f'<Decorator ID="Mine">{CLOSE}</Decorator>', AT_CLOSE + "tend: Mine has children and is no node"),
    (CLOSE, f"<Mine>{CLOSE}</Mine>", AT_CLOSE + "tend: Mine has children and is no node that Arboleda runs"),
    (
        CLOSE,
        f'<ForEachUntilSuccess vector_in="1" out="{{x}}">{CLOSE}</ForEachUntilSuccess>',
        AT_CLOSE + "tend: ForEachUntilSuccess has children and is no node that Arboleda runs",
    ),
    (CLOSE, "<mill_close><mill_open/></mill_close>", AT_CLOSE + "mill_close has 1 child; it needs none"),
    (CLOSE, '<mill_close speed="1"/>', "11:19: mill_close has no port 'speed'"),
    (CLOSE, f'<Precondition if="{{seen}}">{CLOSE}</Precondition>', "if of Precondition is a variable"),
    (CLOSE, f'<Precondition if="true" else="RUNNING">{CLOSE}</Precondition>', "would never end"),
    (
        CLOSE,
        f"<Parallel>{CLOSE}<mill_open/></Parallel>",
        AT_CLOSE
        + "tend has mill do two things at once, in a parallel; it does one after the other: a Sequence",
    ),
    (CLOSE, "<Script code=\"blank := 'slot_2'\"/>", "which the tree changes while it runs"),
    (
        'name="program">',
        'name="program" type="bool">',
        "13:19: program of mill_run must be a whole number; the port",
    ),
    (CLOSE, '<include path="a&#0;b"/>', "11:"),
    ('target="vise"', 'target="vice"', "did you mean vise?"),
    (
        'to="vise"',
        'to="{seen}"',
        "31:7: tend cannot be built: target of loader_visit is '{to}', which is known",
    ),
    ('width_mm="30"', 'width_mm="30000"', "29:20: width_mm of jaw_close must be from 0 to 85"),
    ("seen == 'good'", "sen == 'good'", "the variable 'sen' is read, and nothing gives it a value"),
    ('ID="TakeOut" to="done"', 'ID="Take" to="done"', "the tree 'Take' is in none of these files"),
    ('<input_port name="program">', '<input_port name="depth"/><input_port name="program">', "depth of tend"),
    (
        '<input_port name="program">',
        '<output_port name="x"/><input_port name="program">',
        "the port 'x' gives",
    ),
    ('main_tree_to_execute="Tend"', "", "tend.xml:1:1: which tree?"),
)


def refusal(folder: Path) -> str:
    with pytest.raises(ConfigError) as refused:
        load(folder / "plant.yaml")
    return "\n".join(refused.value.problems)


@pytest.mark.sampled(9)
@pytest.mark.parametrize(("good", "wrong", "said"), WRONG)
def test_what_cannot_be_run_is_refused_with_its_place(
    tmp_path: Path, good: str, wrong: str, said: str
) -> None:
    copytree(EXAMPLE, tmp_path, dirs_exist_ok=True)
    tree = tmp_path / "tend.xml"
    text = tree.read_text("utf-8")
    assert good in text
    tree.write_text(text.replace(good, wrong, 1), "utf-8")
    told = refusal(tmp_path)
    assert said in told
    assert str(tree) in told


def test_a_tree_that_grows_with_its_subtrees_is_refused_at_once(tmp_path: Path) -> None:
    copytree(EXAMPLE, tmp_path, dirs_exist_ok=True)
    trees = [f'<SubTree ID="T{n + 1}" p="{{p}}"/>' * 2 for n in range(60)] + ['<mill_run program="{p}"/>']
    model = '<TreeNodesModel><SubTree ID="T0"><input_port name="p"/></SubTree></TreeNodesModel>'
    written = "".join(
        f'<BehaviorTree ID="T{n}"><Sequence>{each}</Sequence></BehaviorTree>' for n, each in enumerate(trees)
    )
    head = '<root BTCPP_format="4" main_tree_to_execute="T0">'
    (tmp_path / "tend.xml").write_text(f"{head}{written}{model}</root>", "utf-8")
    told = refusal(tmp_path).splitlines()
    assert [each.rpartition("; ")[2] for each in told] == [
        "a recipe has at most 100",
        "a recipe has at most 2000",
    ]


def test_a_tree_that_is_not_used_may_be_of_any_kind(tmp_path: Path) -> None:
    copytree(EXAMPLE, tmp_path, dirs_exist_ok=True)
    tree = tmp_path / "tend.xml"
    body = "<SpeedController><of_another_plant/></SpeedController>"
    other = f'<BehaviorTree ID="Other">{body}</BehaviorTree></root>'
    tree.write_text(tree.read_text("utf-8").replace("</root>", other), "utf-8")
    assert [each.name for each in load(tmp_path / "plant.yaml").cells[0].recipes] == ["tend"]


def test_every_known_node_runs_or_is_refused_with_another_one() -> None:
    assert set(BUILT_IN) - set(MAKERS) == set(INSTEAD)


def test_the_reference_says_which_nodes_do_not_run() -> None:
    part = PAGE.read_text("utf-8").split("## Which nodes run")[1].split("\n## ")[0]
    assert [name for name in sorted(INSTEAD) if f"`{name}`" not in part] == []


def test_a_tree_of_a_file_that_is_not_here_is_refused_with_how_to_find_that(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    copytree(EXAMPLE, tmp_path, dirs_exist_ok=True)
    body = '<include ros_pkg="pick" path="a.xml"/><BehaviorTree ID="T"><SubTree ID="Far"/></BehaviorTree>'
    (tmp_path / "tend.xml").write_text(f'<root BTCPP_format="4" main_tree_to_execute="T">{body}</root>')
    assert "the tree 'Far' is in none of these files; one that they include is not here" in refusal(tmp_path)
