"""Differences between two sets of a plant's files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.document import Place
from arboleda.plant_file.recipe_forms import XML
from arboleda.plant_file.yaml_marks import YamlFault, parse

from .change import CELLS, KINDS, MISSING, TARGETS, VERBS, Change

if TYPE_CHECKING:
    from arboleda_trees.bt_xml.forest import Node


def changes(before: PlantFiles, after: PlantFiles) -> tuple[Change, ...]:
    """The changes in `after`: values of the plant file in its order, then trees, then other files.

    Another layout of a plant file, or other comments, are no change.
    """
    differences = [*_of_plant(before, after)]
    names = sorted(before.contents.keys() | after.contents.keys())
    for name in [each for each in names if each not in (before.plant, after.plant)]:
        differences += _of_file(name, before.contents.get(name), after.contents.get(name))
    return tuple(differences)


def _of_plant(before: PlantFiles, after: PlantFiles) -> Iterator[Change]:
    old, new = before.contents.get(before.plant, b""), after.contents.get(after.plant, b"")
    try:
        values = [parse(each)[0].value for each in (old, new)]
    except YamlFault:  # one cannot be read; `check` reports its place
        if old != new:
            yield Change(file=after.plant, before=None, after=None)
        return
    for each in _of_values(after.plant, (), *values):
        is_new_device = each.is_device and isinstance(each.after, dict)
        yield replace(each, verbs=_verbs(values[1], each.after.get("kind"))) if is_new_device else each


def _verbs(plant: Any, kind: Any) -> tuple[str, ...]:
    """The verbs of a kind that a plant file declares; none where it is written in another way."""
    node = plant
    for key in (KINDS, kind, VERBS):
        node = node.get(key) if isinstance(node, dict) and isinstance(key, str) else None
    return tuple(map(str, node)) if isinstance(node, dict) else ()


def _of_values(file: str, place: Place, before: Any, after: Any) -> Iterator[Change]:
    """The changes inside a value: mappings are compared key by key, down to a pose, which is one value."""
    is_pose = len(place) == 5 and (place[0], place[2]) == (CELLS, TARGETS)
    if isinstance(before, dict) and isinstance(after, dict) and not is_pose:
        for key in [*before, *(key for key in after if key not in before)]:
            yield from _of_values(file, (*place, key), before.get(key, MISSING), after.get(key, MISSING))
    elif _is_listed_apart(place, before, after):
        rows = [{} if each is MISSING else each for each in (before, after)]
        yield from _of_values(file, place, *rows)
    elif before != after:
        yield Change(file=file, place=place, before=before, after=after)


def _is_listed_apart(place: Place, before: Any, after: Any) -> bool:
    """True for all kinds, or a target, new or gone: then each kind, or the pose of each robot, is listed."""
    is_target = len(place) == 4 and (place[0], place[2]) == (CELLS, TARGETS)
    if place != (KINDS,) and not is_target:
        return False
    values = [each for each in (before, after) if each is not MISSING]
    return len(values) == 1 and isinstance(values[0], dict) and bool(values[0])


def _of_file(name: str, before: bytes | None, after: bytes | None) -> Iterator[Change]:
    if before == after:
        return
    if before is not None and after is not None and name.endswith(XML):
        yield from _of_trees(name, before, after)
        return
    values = [MISSING if each is None else None for each in (before, after)]
    yield Change(file=name, before=values[0], after=values[1])


def _of_trees(name: str, before: bytes, after: bytes) -> Iterator[Change]:
    """The trees of a file that are new, gone or changed; the file itself where no tree differs."""
    old, new = _trees(name, before), _trees(name, after)
    differences = [
        Change(file=name, tree=tree, before=None if tree in old else MISSING, after=None)
        for tree in new
        if old.get(tree) != new[tree]
    ]
    differences += [
        Change(file=name, tree=tree, before=None, after=MISSING) for tree in old if tree not in new
    ]
    yield from differences or [Change(file=name, before=None, after=None)]


def _trees(name: str, content: bytes) -> dict[str, str]:
    """The trees of one file by name, as text that does not depend on its layout."""
    from arboleda_trees.bt_xml import reading  # which a plant without trees as XML does not need
    from arboleda_trees.bt_xml.findings import Findings

    forest = reading.read(name, content, Findings())
    return {each: _tree_text(tree.root) for each, tree in forest.trees.items()}


def _tree_text(node: Node) -> str:
    attributes = {**node.own, **node.ports}
    words = [f"{key}={each.value!r}" for key, each in sorted(attributes.items())]
    return f"({node.kind} {node.name!r} {' '.join(words)} {''.join(map(_tree_text, node.children))})"
