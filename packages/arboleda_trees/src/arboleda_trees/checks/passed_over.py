"""Check of trees as XML: nodes that let a task succeed although its work failed, or was broken off."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from py_trees.behaviour import Behaviour

from arboleda.drivers import Command, Switch, Work
from arboleda.engine import Act, Context, Plant
from arboleda.model.orders import orders
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.plant_check.asking import facts_asked, facts_that_tell, question_about
from arboleda.plant_check.walkthrough import in_order
from arboleda.recipes.of_files import FileRecipe
from arboleda_trees.bt_xml.running.controls import Parallel
from arboleda_trees.bt_xml.running.decorators import ALL_DONE, ResultDecorator
from arboleda_trees.bt_xml.running.node import FAILURE, Node

from .what_follows import Course, needs_all

MOST_NAMED = 3  # commands in one sentence


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """A sentence for each such node of the plant's trees, with its place."""
    runs = Plant(plant, epoch=0, now=0.0).cells
    sentences = [
        f"{node.place}: {cell.name}: {recipe.name} {sentence}"
        for cell in plant.cells
        for recipe in cell.recipes
        if isinstance(recipe, FileRecipe)
        for node, sentence in _of_recipe(cell, recipe, runs[cell.name].context)
    ]
    return tuple(dict.fromkeys(sentences))


def _of_recipe(cell: Cell, recipe: FileRecipe, context: Context) -> Iterator[tuple[Node, str]]:
    """The nodes with their sentences. Parameters change the values of a tree and not its nodes."""
    for order in orders(cell, recipe):
        tree = _Tree(tree=recipe.build(order, context).children[0])
        if not any(isinstance(node, ResultDecorator | Parallel) for node in tree.nodes):
            return
        yield from tree.sentences(cell, {what for end in recipe.ends_of(order.values) for what in end})


@dataclass(frozen=True)
class _Tree:
    """The work of a recipe, without its recovery; `nodes` are in the order in which they begin."""

    tree: Behaviour

    @cached_property
    def nodes(self) -> list[Behaviour]:
        return list(in_order(self.tree))

    def _after(self, node: Node) -> Course:
        return Course.after(node, tree=self.tree)

    def sentences(self, cell: Cell, ends: set[str]) -> Iterator[tuple[Node, str]]:
        for node in self.nodes:
            if isinstance(node, ResultDecorator) and node.ends is ALL_DONE:
                yield from ((node, sentence) for sentence in _forced(node, self._after(node), cell))
            elif isinstance(node, Parallel) and not needs_all(node):
                yield from ((node, sentence) for sentence in _held_parts(node, self._after(node), cell, ends))


def _forced(node: ResultDecorator, course: Course, cell: Cell) -> Iterator[str]:
    """The objection to a ForceSuccess below which work may fail that no later node asks about."""
    work = [each for each in _commands(node) if isinstance(each, Work | Switch)]
    if course.result is FAILURE or not work:
        return
    asked = {fact for later in course.later for fact in facts_asked(later, cell)}
    work = [each for each in work if asked.isdisjoint(facts_that_tell(each, cell))]
    names = list(dict.fromkeys(f"{each.robot} {each.word}" for each in work))
    if names:
        shown = f"{', '.join(names[:MOST_NAMED])}{' ...' if len(names) > MOST_NAMED else ''}"
        how = f"{question_about(work[0], cell)} afterwards, or say in a Fallback what is done instead"
        yield f"has ForceSuccess pass over a failure of {shown}, and is done all the same; {how}"


def _held_parts(node: Parallel, course: Course, cell: Cell, ends: set[str]) -> Iterator[str]:
    """The objections to a Parallel that may end while a hand holds a part that it never lets go."""
    freed = {each.robot for later in course.later for each in _grips(later, grips=False)}
    for role, device in cell.members if course.result is not FAILURE else ():
        takes = any(each.robot == device.name for each in _grips(node, grips=True))
        if takes and device.name not in freed and f"{role}.{device.held_fact}" not in ends:
            many = f"Parallel end before all of its {len(node.children)} children are done"
            how = "let all of them succeed, or let go of the part after it"
            yield f"has {many}, and may be done with a part that {device.name} holds; {how}"


def _commands(node: Behaviour) -> list[Command]:
    return [each.make(id="") for each in in_order(node) if isinstance(each, Act)]


def _grips(node: Behaviour, *, grips: bool) -> Sequence[Switch]:
    """The commands below a node that take hold of a part, or let go of it."""
    commands = _commands(node) if isinstance(node, Act) or node.children else []
    return [each for each in commands if isinstance(each, Switch) and each.grips is grips]
