"""Equal cells: those that differ in nothing but their names and those of their own devices.

All that a cell shares keeps its name: a device, a zone, an interlock on a device of another cell. So equal
cells have the same neighbours, and one is to them what the other is. What recipes make of the names is in
the trees that they build, which are compared.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator, Mapping
from dataclasses import fields, is_dataclass

from py_trees.behaviour import Behaviour

from arboleda.engine import Act, Context, Leaf, Plant
from arboleda.extension import Sentence
from arboleda.model.orders import orders
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.tree_nodes import nodes_of

Names = Mapping[str, Hashable]  # what stands for a name in every cell that is equal


def equal_cells(model: PlantModel) -> dict[str, str]:
    """For each cell the first one that is equal to it, by their names."""
    declared = {cell.name: _with(_names(cell), cell) for cell in model.cells}
    times = Counter(declared.values())
    runs = Plant(model, epoch=0, now=0.0).cells
    firsts: dict[Hashable, str] = {}
    for cell in model.cells:
        said = declared[cell.name]
        built = tuple(_trees(cell, runs[cell.name].context)) if times[said] > 1 else ()
        declared[cell.name] = said, built
    return {name: firsts.setdefault(whole, name) for name, whole in declared.items()}


def notes(model: PlantModel) -> Iterator[str]:
    """A line for each cell that others are equal to."""
    firsts = equal_cells(model)
    for first in dict.fromkeys(firsts.values()):
        others = [name for name, like in firsts.items() if like == first != name]
        if others:
            yield f"equal to {first} but for names, so proved once, in {first}: {', '.join(others)}"


def _names(cell: Cell) -> dict[str, Hashable]:
    """The roles of its own devices by their names, as no other text is, and a word for its own name."""
    own = [(role, robot) for role, robot in cell.members if robot.name in cell.own]
    return {name: (role,) for role, robot in own for name in (robot.mqtt, robot.name)} | {cell.name: ()}


def _trees(cell: Cell, context: Context) -> Iterator[Hashable]:
    """All that the recipes of a cell build for each of their tasks: their nodes, commands and titles."""
    names = _names(cell)
    for recipe in cell.recipes:
        for order in orders(cell, recipe):
            yield tuple(_node(names, node) for node in nodes_of(recipe.build(order, context)))


def _node(names: Names, node: Behaviour) -> Hashable:
    title = node.title if isinstance(node, Leaf) else None
    command = node.make(id="") if isinstance(node, Act) else None
    return type(node).__qualname__, len(node.children), _with(names, title), _with(names, command)


def _with(names: Names, value: object) -> Hashable:
    """A value as one that can be compared, with other names."""
    if isinstance(value, str):
        return type(value), *(names.get(word, word) for word in value.split(" "))  # of a title several
    if isinstance(value, Sentence):
        return value.key, _with(names, value.values)
    if is_dataclass(value) and not isinstance(value, type):
        shown = [each.name for each in fields(value) if each.compare]
        return type(value), tuple(_with(names, getattr(value, each)) for each in shown)
    if isinstance(value, Mapping):
        return frozenset((_with(names, key), _with(names, each)) for key, each in value.items())
    if isinstance(value, list | tuple):
        return tuple(_with(names, each) for each in value)
    if isinstance(value, set | frozenset):
        return frozenset(_with(names, each) for each in value)
    return value if isinstance(value, Hashable) else id(value)
