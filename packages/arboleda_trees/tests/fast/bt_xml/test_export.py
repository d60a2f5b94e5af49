"""A tree of the plant as XML: read again it is the same tree, in trees of 20 nodes at most."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda_trees.bt_xml.export import LARGEST, PART, export
from arboleda_trees.bt_xml.forest import Forest, Node

from .findings import looked_at

ROOT = Path(__file__).parents[5]
KINDS = {"Sequence": "sequence", "Fallback": "selector", "Parallel": "parallel"}
TENDING = ROOT / "examples/machine_tending/plant.yaml"
KITTING = ROOT / "examples/kitting/plant.yaml"


def row(path: str, kind: str, name: str = "n", **parameters: object) -> dict[str, Any]:
    return {"path": path, "kind": kind, "name": name, "parameters": parameters}


def outline(forest: Forest, node: Node) -> list[Any]:
    """A node as name, kind and children, with what only splits trees up taken out."""
    if node.is_subtree:
        return outline(forest, forest.trees[node.own["ID"].value].root)
    below: list[Any] = []
    for child in node.children:
        found = outline(forest, child)
        below += found[2] if PART in child.own else [found]
    return [node.name, KINDS.get(node.kind, "other"), below]


def outline_of_rows(rows: list[dict[str, Any]], path: str = "root") -> list[Any]:
    found = next(each for each in rows if each["path"] == path)
    below = [each["path"] for each in rows if each["path"] != "root" and parent(each["path"]) == path]
    kind = found["kind"] if found["kind"] in KINDS.values() and below else "other"
    return [str(found["name"]), kind, [outline_of_rows(rows, each) for each in below]]


def parent(path: str) -> str:
    return path.rpartition(".")[0] or "root"


def read_again(text: str) -> Forest:
    forest, findings, leaves = looked_at(text)
    assert findings.mistakes == () and leaves == []
    for tree in forest.trees.values():
        assert len(list(tree.root.iterate())) <= LARGEST
    return forest


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("recipe", "plant"),
    [
        ("storage", None),
        ("palletizing", None),
        ("tending mill slot_1 1001", TENDING),
        ("kitting wave tray_1", KITTING),
    ],
)
def test_a_recipe_is_the_same_tree_when_it_is_read_again(recipe: str, plant: Path | None) -> None:
    def tree(format: str) -> str:
        words = ["tree", recipe, "--format", format, *(["--plant", str(plant)] if plant else [])]
        return CliRunner().invoke(cli, words, catch_exceptions=False).stdout

    forest = read_again(tree("xml"))
    assert forest.main is not None
    names = [node.name for node in _inlined(forest, forest.trees[forest.main].root)]
    assert names == [line.split(maxsplit=1)[1] for line in tree("ascii").splitlines()]


def _inlined(forest: Forest, node: Node) -> list[Node]:
    if node.is_subtree:
        root = forest.trees[node.own["ID"].value].root
        return _inlined(forest, root)[PART in node.own :]
    return [node, *(each for child in node.children for each in _inlined(forest, child))]


@pytest.mark.parametrize("many", [1, 19, 20, 39, 400])
def test_a_node_of_many_children_is_split_up_and_is_the_same_tree(many: int) -> None:
    rows = [row("root", "sequence"), *(row(str(number), "command", f"c{number}") for number in range(many))]
    forest = read_again(export(rows))
    assert forest.main is not None
    assert outline(forest, forest.trees[forest.main].root) == outline_of_rows(rows)


def test_a_long_chain_is_split_up() -> None:
    paths = ["root", *(".".join(["0"] * depth) for depth in range(1, 60))]
    rows = [row(path, "sequence", f"s{depth}") for depth, path in enumerate(paths)]
    forest = read_again(export(rows))
    assert forest.main is not None
    assert outline(forest, forest.trees[forest.main].root) == outline_of_rows(rows)


def test_names_and_values_are_written_so_that_they_are_read_as_they_were() -> None:
    odd = "a \"b\" <c> & 'd'\n\te {f}"
    forest = read_again(export([row("root", "sequence", odd), row("0", "condition", odd, seconds=odd)]))
    root = forest.trees[forest.main or ""].root
    assert root.name == odd and root.children[0].port("seconds") == odd


def test_a_decorator_of_ones_own_is_one_and_trees_of_one_name_are_told_apart() -> None:
    rows = [
        row("root", "step", "a b"),
        row("0", "parallel", "a b"),
        *(row(f"0.{n}", "dwell") for n in range(19)),
    ]
    forest = read_again(export(rows))
    assert {"AB", "AB2"} <= set(forest.trees)
    assert forest.models["StepDecorator"].category.value == "Decorator"
