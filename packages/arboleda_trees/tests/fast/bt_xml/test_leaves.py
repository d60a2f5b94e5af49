"""Devices of a plant as nodes of a tree, and trees that are checked against them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader
from arboleda_trees.bt_xml import checking, leaves, reading
from arboleda_trees.bt_xml.findings import Findings
from arboleda_trees.bt_xml.nodes import Category, Kind, PortDirection

from .findings import looked_at, tree

PLANT = Path(__file__).parents[5] / "examples/machine_tending/plant.yaml"


@pytest.fixture(scope="module")
def kinds() -> dict[str, Kind]:
    return leaves.of_cells(loader.load(PLANT).cells)


def run(*words: object) -> Result:
    return CliRunner().invoke(cli, [str(word) for word in words])


def found(body: str, kinds: dict[str, Kind]) -> Findings:
    findings = Findings()
    forest = reading.read("t.xml", tree(body).encode(), findings)
    checking.check(forest, findings, kinds)
    return findings


def mistakes(body: str, kinds: dict[str, Kind]) -> tuple[str, ...]:
    return found(body, kinds).mistakes


@pytest.mark.parametrize("node", ["says", "tells", 'becomes at_most_s="2"'])
def test_a_node_about_no_fact_is_a_warning(kinds: dict[str, Kind], node: str) -> None:
    (warning,) = found(f"<mill_{node}/>", kinds).warnings
    assert "is about no fact; give it some of door, clamped" in warning


def test_verbs_questions_facts_and_targets_are_nodes_with_typed_ports(kinds: dict[str, Kind]) -> None:
    program = (kinds["mill_run"].ports or {})["program"]
    assert (program.type, program.words, program.is_needed) == ("int", ("1001", "1002"), True)
    assert (kinds["camera_look"].ports or {})["answer"].direction is PortDirection.OUT
    assert kinds["mill_says"].category is Category.CONDITION
    assert kinds["loader_visit"].category is Category.DECORATOR
    assert "vise" in (kinds["loader_go"].ports or {})["target"].words
    assert set(kinds["operator_ask"].ports or {}) == {"question", "answers", "at_most_s", "answer"}


@pytest.mark.parametrize(
    "body",
    [
        '<mill_run program="1001"/>',
        '<mill_run program="{program}"/>',
        '<loader_visit target="slot_1"><loader_grip/></loader_visit>',
        '<camera_look answer="{seen}"/>',
        '<mill_says door="open"/>',
        '<jaw_close width_mm="40.5" force_n="60"/>',
        '<operator_ask question="Full again?" answers="yes;no" answer="{said}"/>',
    ],
)
def test_what_the_plant_has_is_taken(body: str, kinds: dict[str, Kind]) -> None:
    assert mistakes(body, kinds) == ()


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("<mill_rum/>", "no device of this plant makes a node mill_rum; did you mean mill_run?"),
        ('<Action ID="Zap"/>', "no device of this plant makes a node Zap; `arboleda nodes` lists"),
        ("<mill_run/>", "mill_run needs program: a whole number, or a variable"),
        ('<mill_run program="1003"/>', "program of mill_run is '1003'; there are 1001, 1002"),
        ('<jaw_close width_mm="40" force_n="61"/>', "force_n of jaw_close must be from 0 to 60, is '61'"),
        ('<jaw_close width_mm="nan" force_n="6"/>', "width_mm of jaw_close must be from 0 to 85"),
        ('<loader_go target="slot_9"/>', "target of loader_go is 'slot_9'; there are home, slot_1"),
        ('<loader_visit target="vise"/>', "loader_visit has no children; it needs 1"),
        (
            '<mill_says dor="open"/>',
            "mill_says has no port 'dor'; there are door, clamped; did you mean door?",
        ),
    ],
)
def test_what_it_has_not_is_told(body: str, words: str, kinds: dict[str, Kind]) -> None:
    (found,) = mistakes(body, kinds)
    assert words in found


def test_the_palette_is_read_again_as_it_was(kinds: dict[str, Kind]) -> None:
    printed = run("nodes", "--plant", PLANT, "--xml").stdout
    forest, findings, _ = looked_at(printed)
    assert findings.mistakes == () and set(forest.models) == set(kinds)
    for name, kind in kinds.items():
        found = forest.models[name]
        assert found.category is kind.category
        there = {port.name: (port.direction, port.default) for port in (found.ports or {}).values()}
        assert there == {port.name: (port.direction, port.default) for port in (kind.ports or {}).values()}
    assert '<input_port name="program" type="int">1001, 1002</input_port>' in printed


def test_people_read_a_line_for_each_node() -> None:
    lines = run("nodes", "--plant", PLANT).stdout.splitlines()
    assert "Action mill_run: program (1001, 1002)" in lines
    assert "Action camera_look: gives answer (one of good, bad, unsure)" in lines


def test_a_tree_is_checked_against_a_plant_on_the_command_line(tmp_path: Path) -> None:
    file = tmp_path / "tend.xml"
    file.write_text(tree("<Sequence><mill_open/><Retract/></Sequence>"))
    assert run("check", file).exit_code == 0
    assert "no device of this plant makes a node Retract" in str(
        run("check", file, "--plant", PLANT).exception
    )
    assert run("check", PLANT, "--plant", PLANT).exit_code == 2
    assert run("check", file, "--plant", PLANT, "--cell", "no").exit_code == 2


def test_nodes_of_one_name_in_two_cells_must_be_the_same() -> None:
    (cell,) = loader.load(PLANT).cells
    other = replace(cell, name="other")
    assert leaves.of_cells([cell, other]) == leaves.of_cell(cell)
    rows = [(role, cell.roles["belt"] if role == "mill" else robot) for role, robot in cell.members]
    with pytest.raises(
        ConfigError, match=r"mill_says is not the same in .* and other; choose --cell .* or --cell other"
    ):
        leaves.of_cells([cell, replace(other, members=tuple(rows))])


TWO = """
name: lab
uses: [bake.xml]
kinds:
  oven: {verbs: {run: {effect: process, with: {celsius: [40, 60]}}, open: {effect: process}}}
  mill: {verbs: {run: {effect: process, with: {program: [1, 2]}}, open: {effect: process}}}
cells:
  baking: {devices: {machine: {kind: oven, name: oven}}}
  milling: {devices: {machine: {kind: mill, name: mill}}}
"""


@pytest.mark.parametrize(
    ("body", "is_good"),
    [
        ('<machine_run celsius="40"/>', True),
        ('<machine_run program="2"/>', True),
        ("<machine_open/>", True),
        ('<machine_run celsius="50"/>', False),
        ("<machine_close/>", False),
    ],
    ids=["one", "the other", "both", "neither", "no cell has the node"],
)
def test_a_tree_is_checked_for_the_cells_that_can_run_it(tmp_path: Path, body: str, is_good: bool) -> None:
    (tmp_path / "plant.yaml").write_text(TWO, "utf-8")
    (tmp_path / "bake.xml").write_text(tree("<machine_open/>"), "utf-8")
    file = tmp_path / "tend.xml"
    file.write_text(tree(body), "utf-8")
    found = run("check", file, "--plant", tmp_path / "plant.yaml")
    if is_good:
        assert found.output == f"{file}: good: 1 nodes; trees Main\n"
    else:
        assert "choose --cell baking or --cell milling" in str(found.exception)
