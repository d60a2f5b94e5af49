"""One check tells all mistakes of a tree: those of its file, and those in the cells that use it."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.plants import plant_text

from arboleda.model.errors import ConfigError
from arboleda.plant_file.loader import load

PLANT = plant_text(__file__, "mistakes_of_trees")
VISIT = "<mover_visit target='{}'><press_open/></mover_visit>"


def said(folder: Path, *lines: str, model: str = "") -> list[str]:
    """All that is wrong with a tree of these lines, the first of which is line 2."""
    tree = "\n".join(lines)
    text = f'<root BTCPP_format="4"><BehaviorTree ID="Go"><Sequence>\n{tree}\n</Sequence></BehaviorTree>'
    (folder / "go.xml").write_text(f"{text}<TreeNodesModel>{model}</TreeNodesModel></root>")
    (folder / "plant.yaml").write_text(PLANT)
    try:
        load(folder / "plant.yaml")
    except ConfigError as error:
        return [each.removeprefix(f"{folder}/go.xml:").partition(";")[0] for each in error.problems]
    return []


def test_mistakes_of_the_file_names_ports_and_the_end_are_told_at_once(tmp_path: Path) -> None:
    ends = "<MetadataFields><Metadata ends_with='outt: 1'/></MetadataFields>"
    assert said(
        tmp_path,
        "<Inverter/>",
        "<press_opne/>",
        "<press_push knn='4' kn='3'/>",
        "<ManualSelector><press_open/></ManualSelector>",
        "<SubTree ID='Gone'/>",
        VISIT.format("inn"),
        model=f"<SubTree ID='Go'>{ends}</SubTree>",
    ) == [
        "2:1: Inverter has no children",
        "5:1: ManualSelector can be drawn and not be run",
        "6:10: the tree 'Gone' is in none of these files",
        "3:1: go: no device of a makes a node press_opne",
        "4:13: press_push has no port 'knn'",
        "7:14: target of mover_visit is 'inn'",
        "8:86: go ends with 'outt'",
    ]


def test_a_parameter_without_values_hides_no_mistake_of_the_tree(tmp_path: Path) -> None:
    model = "<SubTree ID='Go'><input_port name='dose'/></SubTree>"
    assert said(tmp_path, "<press_push kn='x'/>", model=model) == [
        "2:13: kn of press_push must be a whole number, is 'x'",
        "1:1: dose of go has no value to choose",
    ]


def test_a_parameter_is_not_missed_where_an_unknown_node_may_list_its_values(tmp_path: Path) -> None:
    model = "<SubTree ID='Go'><input_port name='dose'/></SubTree>"
    (problem,) = said(tmp_path, "<press_psh kn='{dose}'/>", model=model)
    assert problem == "2:1: go: no device of a makes a node press_psh"


@pytest.mark.parametrize(
    ("line", "mistakes"),
    [
        (
            "<press_push knn='{dose}'/>",
            ["2:1: press_push needs kn: a whole number, or a variable", "2:13: press_push has no port 'knn'"],
        ),
        ("<SubTree ID='Gone' kn='{dose}'/>", ["2:10: the tree 'Gone' is in none of these files"]),
        ("<SubTree ID='Gone' _autoremap='true'/>", ["2:10: the tree 'Gone' is in none of these files"]),
    ],
)
def test_a_parameter_is_not_missed_where_it_stands_at_a_mistake(
    tmp_path: Path, line: str, mistakes: list[str]
) -> None:
    model = "<SubTree ID='Go'><input_port name='dose'/></SubTree>"
    assert said(tmp_path, line, model=model) == mistakes
    model = "<SubTree ID='Go'><input_port name='dose'/><input_port name='size'/></SubTree>"
    size = [] if "_autoremap" in line else ["1:1: size of go has no value to choose"]
    assert said(tmp_path, line, model=model) == [*mistakes, *size], "another one is"


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("<Script code='kn := := 3'/>", "2:"),
        ("<Scrpt code='kn := 3'/>", "2:1: go: no device of a makes a node Scrpt"),
        ("<SetBlackbord output_key='kn' value='3'/>", "2:1: go: no device of a makes a node SetBlackbord"),
        ("<SetBlackboard outputkey='kn' value='3'/>", "2:"),
        ("<SubTree ID='Gone' _autoremap='true'/>", "2:10: the tree 'Gone' is in none of these files"),
    ],
)
def test_a_variable_is_not_missed_where_a_mistake_may_hide_what_gives_it_a_value(
    tmp_path: Path, line: str, told: str
) -> None:
    problems = said(tmp_path, line, "<press_push kn='{kn}'/>")
    assert problems and all(each.startswith(told) for each in problems)


def test_a_variable_that_nothing_gives_a_value_is_told_beside_other_mistakes(tmp_path: Path) -> None:
    assert said(tmp_path, "<Scrpt code='sze := 3'/>", "<press_push kn='{kn}'/>") == [
        "2:1: go: no device of a makes a node Scrpt",
        "3:13: the variable 'kn' is read, and nothing gives it a value",
    ]


def test_all_leaves_that_cannot_be_made_are_told_at_once(tmp_path: Path) -> None:
    script = "<Script code=\" there := 'in' \"/>"
    why = "go cannot be built: target of mover_visit is '{there}', which is known only while the tree runs"
    assert said(tmp_path, script, VISIT.format("{there}"), VISIT.format("{there}")) == [
        f"3:1: {why}",
        f"4:1: {why}",
    ]


def test_each_parallel_in_which_a_device_does_two_things_is_told(tmp_path: Path) -> None:
    parallel = "<Parallel><press_open/><press_push kn='1'/></Parallel>"
    why = "go has press do two things at once, in a parallel"
    assert said(tmp_path, parallel, parallel) == [f"2:1: {why}", f"3:1: {why}"]


def test_trees_of_which_none_is_named_are_told_beside_other_mistakes(tmp_path: Path) -> None:
    second = "</Sequence></BehaviorTree><BehaviorTree ID='Other'><Sequence><press_open/><Inverter/>"
    assert said(tmp_path, "<Inverter/>", second) == [
        '1:1: which tree? <root main_tree_to_execute="...">',
        "2:1: Inverter has no children",
        "3:75: Inverter has no children",
    ]


def test_a_tree_that_contains_itself_is_told_alone_where_it_is_used(tmp_path: Path) -> None:
    assert said(tmp_path, "<SubTree ID='Go'/>", "<press_opne/>") == [
        "2:1: the tree Go contains itself: Go > Go"
    ]
