"""Scenarios: a task for each class of a recipe's parameters, with the answers of those whom it asks."""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable, Iterator
from dataclasses import dataclass, replace

from py_trees.behaviour import Behaviour

from arboleda.drivers import Motion, Value, shown
from arboleda.engine import Act, Context, Leaf, Plant
from arboleda.model.orders import orders
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.tree_nodes import nodes_of
from arboleda.recipes import Order, Recipe

from .equal_cells import equal_cells

MOST_CLASSES = 32  # of one recipe


@dataclass(frozen=True, kw_only=True)
class Scenario:
    """Scenario: a task that stands for `alike` ones, and what those answer who do not give their first.

    `brought`: the places of the cell to which people bring a part before they ask for it.
    """

    cell: str
    recipe: str
    task: str
    answers: tuple[tuple[str, Value], ...] = ()
    alike: int = 1
    brought: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The task as it is typed, with what is brought and with the answers."""
        words = [f"a part is brought to {place}" for place in self.brought]
        words += [f"{who} says {shown(word)}" for who, word in self.answers]
        return f"{self.task} ({', '.join(words)})" if words else self.task

    def with_part(self, place: str) -> Scenario:
        """The same task where people bring a part to a place before."""
        return replace(self, brought=(*self.brought, place))

    def with_answer(self, who: str, word: Value) -> Scenario:
        """The same task where somebody answers otherwise."""
        answers = tuple(sorted((dict(self.answers) | {who: word}).items()))
        return replace(self, answers=answers)


def scenarios(model: PlantModel, recipes: Collection[str] = ()) -> Iterator[Scenario]:
    """A scenario for each class of parameters, of these recipes or of all, in the first of cells that are
    equal; who is asked answers the first.
    """
    firsts = equal_cells(model)
    runs = Plant(model, epoch=0, now=0.0).cells
    for cell in (each for each in model.cells if firsts[each.name] == each.name):
        for recipe in cell.recipes:
            if not recipes or recipe.name in recipes:
                yield from _of_recipe(cell, recipe, runs[cell.name].context)


def alone(model: PlantModel, name: str) -> PlantModel:
    """The plant without the cells that a cell cannot meet: they share no device with it, and no zone."""
    cell = model.cell(name)
    if model.zones:
        return model
    kept = [each for each in model.cells if each is cell or not set(each.shared).isdisjoint(cell.shared)]
    return replace(model, cells=tuple(kept))


def _of_recipe(cell: Cell, recipe: Recipe, context: Context) -> Iterator[Scenario]:
    classes: dict[Hashable, list[Order]] = {}
    for order in orders(cell, recipe):
        classes.setdefault(shape(cell, recipe.build(order, context)), []).append(order)
    for alike in [*classes.values()][:MOST_CLASSES]:
        words = alike[0].text.split()
        task = " ".join([words[0], *words[2:]] if recipe.goes_unnamed else words)
        yield Scenario(cell=cell.name, recipe=recipe.name, task=task, alike=len(alike))


def shape(cell: Cell, tree: Behaviour) -> Hashable:
    """The part of a tree that decides what it does next: its nodes, whom they command, zones at its goals.

    Where a robot goes within its zones, and which values a device gets, is left out.
    """
    return tuple(_node(cell, node) for node in nodes_of(tree))


def _node(cell: Cell, node: Behaviour) -> Hashable:
    words: list[Hashable] = [type(node).__qualname__, len(node.children)]
    if isinstance(node, Leaf):
        words.append(node.title.key)
    if isinstance(node, Act):
        command = node.make(id="")
        words += [type(command).__qualname__, command.robot, getattr(command, "verb", "")]
        words += [_zones(cell, command.robot, command.way[-1:])] if isinstance(command, Motion) else []
    return tuple(words)


def _zones(cell: Cell, robot: str, goals: Iterable[object]) -> frozenset[str]:
    space = cell.workspaces.get(robot)
    poses = [pose for pose in space.poses if pose.q in goals] if space is not None else []
    return frozenset(zone for pose in poses for zone in pose.zones)
