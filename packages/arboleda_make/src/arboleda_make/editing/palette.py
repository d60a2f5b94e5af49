"""Palette of a cell: all kinds of nodes that a tree may have there, in groups, as plain data."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from arboleda.model.plant_model import Cell
from arboleda.recipes import WrittenNode
from arboleda_trees.bt_xml import leaves
from arboleda_trees.bt_xml.nodes import OF_LIBRARY, OF_MOVEIT, OF_NAV2, Category, Kind, Port
from arboleda_trees.bt_xml.runnable import INSTEAD

Row = dict[str, Any]
OLD = ("success_threshold", "failure_threshold", "threshold")  # ports of version 3
GROUPS = {
    Category.CONTROL: "control",
    Category.DECORATOR: "decorator",
    Category.CONDITION: "condition",
    Category.ACTION: "action",
}
DEVICE, PYTHON, USUAL, OTHERS = "device", "python", "usual", "others"
USUAL_KINDS = (
    *("Sequence", "Fallback", "Parallel", "IfThenElse", "Switch2", "TryCatch"),
    *("RetryUntilSuccessful", "Repeat", "Timeout", "Inverter", "Sleep", "AlwaysSuccess"),
)


def palette(cell: Cell, own: Iterable[WrittenNode], words: Mapping[str, str]) -> list[Row]:
    """Groups {sort, name, kinds}: one for each device, by its role; nodes in Python; usual ones; all others.

    A kind has `name`, `category`, `fewest` and `most` nodes in it, `about`, and `ports` {name, type, way,
    default, needed, words, lower, upper, about}. `words`: sentences about kinds, by `kind.Sequence`, by what
    a device does, `device.go`, and by port, `port.msec`. ConfigError if two nodes have one name.
    """
    written = tuple(own)
    kinds, roles = leaves.of_cell(cell, written), leaves.roles(cell)
    groups = [_group(DEVICE, role, _of_role(kinds, roles, role), words) for role in cell.roles]
    python = [kinds[each.name] for each in written]
    groups.append(_group(PYTHON, "", python, words))
    groups.append(_group(USUAL, "", [OF_LIBRARY[each] for each in USUAL_KINDS], words))
    library = [each for each in OF_LIBRARY.values() if each.name not in (*INSTEAD, *USUAL_KINDS)]
    library += leaves.of_places(cell).values()
    for category, name in GROUPS.items():
        groups.append(_group(name, "", [each for each in library if each.category is category], words))
    others = [each for each in {**OF_NAV2, **OF_MOVEIT}.values() if each.name not in INSTEAD]
    groups.append(_group(OTHERS, "", others, words))
    return [each for each in groups if each["kinds"]]


def _of_role(kinds: Mapping[str, Kind], roles: Mapping[str, str], role: str) -> list[Kind]:
    return [kind for name, kind in kinds.items() if roles.get(name) == role]


def _group(sort: str, name: str, kinds: Iterable[Kind], words: Mapping[str, str]) -> Row:
    return {"sort": sort, "name": name, "kinds": [_kind(each, name, words) for each in kinds]}


def _kind(kind: Kind, role: str, words: Mapping[str, str]) -> Row:
    about = words.get(f"device.{kind.name.removeprefix(f'{role}_')}" if role else f"kind.{kind.name}", "")
    return {
        "name": kind.name,
        "category": kind.category.value,
        "fewest": kind.fewest,
        "most": kind.most,
        "about": kind.about or about,
        "ports": [_port(each, words) for each in (kind.ports or {}).values() if each.name not in OLD],
    }


def _port(port: Port, words: Mapping[str, str]) -> Row:
    lower, upper = port.limits or (None, None)
    return {
        "name": port.name,
        "type": port.type,
        "way": port.direction.value.removesuffix("_port"),
        "default": port.default,
        "needed": port.is_needed,
        "words": list(port.words),
        "lower": lower,
        "upper": upper,
        "about": port.about or words.get(f"port.{port.name}", ""),
    }
