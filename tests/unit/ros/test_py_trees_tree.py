"""A cell's tree as py_trees_ros tells of trees."""

from __future__ import annotations

from typing import Any

from arboleda_ros.py_trees_tree import (
    BEHAVIOUR,
    DECORATOR,
    NOBODY,
    NONE_YET,
    SELECTOR,
    SEQUENCE,
    Behaviour,
    behaviours,
    idle,
    variables,
)

KINDS = {"root": "selector", "0": "sequence", "0.0": "command", "0.1": "await", "1": "step", "1.0": "note"}
RUNNING = {"root": "RUNNING", "0": "RUNNING", "0.0": "SUCCESS", "0.1": "RUNNING"}


def rows(status: dict[str, str], **given: Any) -> list[dict[str, Any]]:
    return [
        {
            "path": path,
            "name": f"node {path}",
            "kind": kind,
            "status": status.get(path, "INVALID"),
            "feedback": "at it" if path == "0.1" else "",
            "parameters": given if path == "0.1" else {},
        }
        for path, kind in KINDS.items()
    ]


def by_path(found: list[Behaviour]) -> dict[str, Behaviour]:
    return dict(zip(KINDS, found, strict=True))


def test_nodes_know_those_around_and_below_them() -> None:
    node = by_path(behaviours("sis_a", rows(RUNNING)))
    assert node["root"].parent_id == NOBODY
    assert node["0.1"].parent_id == node["0"].own_id
    assert node["0"].child_ids == (node["0.0"].own_id, node["0.1"].own_id)
    assert len({each.own_id for each in node.values()} | {NOBODY}) == len(KINDS) + 1


def test_the_way_of_those_at_work_is_told() -> None:
    node = by_path(behaviours("sis_a", rows(RUNNING)))
    assert node["root"].current_child_id == node["0"].own_id
    assert node["0"].current_child_id == node["root"].tip_id == node["0.1"].own_id
    assert node["1"].current_child_id == NOBODY
    assert [path for path, each in node.items() if each.is_active] == ["root", "0", "0.0", "0.1"]


def test_what_a_node_is_and_how_it_stands_are_numbers_of_py_trees_ros() -> None:
    node = by_path(behaviours("sis_a", rows(RUNNING)))
    types = (SELECTOR, SEQUENCE, BEHAVIOUR, BEHAVIOUR, DECORATOR, BEHAVIOUR)
    assert tuple(each.type for each in node.values()) == types
    assert (node["0.0"].status, node["0.1"].status, node["1"].status) == (3, 2, 1)
    assert (node["0.1"].name, node["0.1"].class_name, node["0.1"].message) == ("node 0.1", "await", "at it")


def test_a_node_keeps_its_id_while_the_tree_is_the_same() -> None:
    before, after = behaviours("sis_a", rows(RUNNING)), behaviours("sis_a", rows({"root": "FAILURE"}))
    assert [each.own_id for each in before] == [each.own_id for each in after]
    elsewhere = behaviours("sis_b", rows(RUNNING))
    assert not {each.own_id for each in before} & {each.own_id for each in elsewhere}


def test_a_tree_whose_task_is_over_is_idle() -> None:
    found = behaviours("sis_a", idle(rows(RUNNING)))
    assert {(each.status, each.is_active, each.message) for each in found} == {(1, False, "")}
    assert [each.name for each in behaviours("sis_a", NONE_YET)] == ["no task yet"]


def test_the_variables_are_those_of_the_task_and_of_steps_that_were_at_work() -> None:
    cell = {"state": "execute", "task": {"id": "lot", "text": "sis_a 0B 7"}, "tree": rows(RUNNING, seconds=2)}
    assert dict(variables(cell)) == {
        "cell/state": "execute",
        "task/id": "lot",
        "task/text": "sis_a 0B 7",
        "node 0.1/seconds": "2",
    }
    assert dict(variables({"state": "idle", "task": None, "tree": []})) == {"cell/state": "idle"}
