"""Check of recipes in advance: each path through a recipe, and how it leaves the cell, without running it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from py_trees.behaviour import Behaviour

from arboleda.engine import Context, Plant
from arboleda.model.facts import Value
from arboleda.model.orders import MOST, combinations, orders
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.recipe import Recipe
from arboleda.model.task import Order
from arboleda.plant_file.target_pose import START
from arboleda.recipes.authoring import WrittenRecipe
from arboleda.recipes.decorators import Again, AtMost
from arboleda.recipes.of_files import FAILURE, ROUNDS, FileNode, FileRecipe

from . import form_checks
from .foresight import OVER, Foresight, Scene
from .notation import Notation
from .recipe_ends import certain_ends, met, never_met, of_ends
from .step_rules import RULES as STEP_RULES
from .walkthrough import Rule, Walkthrough, first_values

MOST_TRIES, LONGEST_S = 100, 3600.0  # of a retry, and the time of its pauses
ENDLESS = "tries {step} again {how_often}; a task that cannot be done never ends so"
AROUND = "; write {limit} around it"
IN_PYTHON, IN_XML = "cell.timeout(step, seconds)", '<Timeout msec="60000">'


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """Warnings of steps that recipes do in vain or forget, each with the place of its recipe."""
    return tuple(sentence for check in _checks(plant) for sentence in check.warnings())


def ends(plant: PlantModel) -> tuple[str, ...]:
    """Ends of recipes: a sentence each with the facts that are certain once a task is done."""
    return tuple(sentence for check in _checks(plant) for sentence in check.ends())


def _checks(plant: PlantModel) -> list[CellCheck]:
    runs, rules = Plant(plant, epoch=0, now=0.0).cells, dict(STEP_RULES)
    for form in form_checks.of_plant(plant):
        rules |= form.rules
    return [CellCheck(cell=cell, context=runs[cell.name].context, rules=rules) for cell in plant.cells]


@dataclass(kw_only=True)
class CellCheck:
    """Follows each path through each recipe of one cell, with all parameters."""

    cell: Cell
    context: Context
    rules: Mapping[type[Behaviour], Rule]
    sentences: dict[str, None] = field(default_factory=dict)
    waits: dict[str, dict[str, str]] = field(default_factory=dict)  # by robot and recipe: its last target

    def warnings(self) -> Iterable[str]:
        written = [each for each in self.cell.recipes if _is_own(each)]
        for recipe in written:
            numbers = [self._check(recipe, order) for order in orders(self.cell, recipe)]
            if combinations(self.cell, recipe) <= MOST:
                self._say(recipe, never_met(recipe.ends_with, set().union(*numbers)))
        for recipe in written:
            self._say(recipe, self._elsewhere(recipe))
        return self.sentences

    def ends(self) -> Iterator[str]:
        for recipe in (each for each in self.cell.recipes if _place(each) is not None):
            ends: list[Scene] = []
            stated: list[Sequence[Mapping[str, Value]]] = []
            for order in orders(self.cell, recipe):
                ends += self._followed(recipe.build(order, self.context), self._notation(recipe))[1]
                stated.append(recipe.ends_of(order.values))
            sure = ", ".join(certain_ends(self.cell, stated, ends) if ends else ())
            yield f"{self.cell.name}: {recipe.name} ends with {sure or 'nothing that is certain'}"

    def _followed(self, tree: Behaviour, notation: Notation) -> tuple[Walkthrough, tuple[Scene, ...]]:
        """The walkthrough of a recipe's tree, and the scenes at the ends of all paths."""
        walk = Walkthrough(foresight=Foresight(self.cell, self._back(), notation), rules=self.rules)
        begin = walk.foresight.begin().put(first_values(tree))
        return walk, walk.follow(tree.children[0], [begin]).passed

    def _back(self) -> dict[str, str]:
        """By robot, the target to which a recovery of this recipe brings the robot's part back."""
        poses = self.context.parts.back
        targets = {robot: self.cell.reach[robot].targets.items() for robot in poses}
        return {
            robot: next(name for name, pose in targets[robot] if pose == back)
            for robot, back in poses.items()
        }

    def _check(self, recipe: Recipe, order: Order) -> set[int]:
        """The numbers of the ends that the recipe states with which a task may end."""
        tree = recipe.build(order, self.context)
        for place, sentence in _endless(tree):
            self._say(recipe, [sentence], place)
        notation = self._notation(recipe)
        walk, ends = self._followed(tree, notation)
        for place, sentence in walk.findings:
            self._say(recipe, [sentence], place)
        self._say(recipe, of_ends(notation, recipe.ends_of(order.values), ends))
        for space in (each for each in self.cell.spaces if each.robot.joints):
            over = {end.get(space.robot.name, OVER) for end in ends}
            if len(over) == 1 and None not in over:
                self.waits.setdefault(space.robot.name, {}).update({recipe.name: str(over.pop())})
        return met(self.cell, recipe.ends_of(order.values), ends)

    def _elsewhere(self, recipe: Recipe) -> Iterator[str]:
        """A sentence for each arm that this recipe leaves elsewhere, while another recipe leaves it at home.

        A robot that drives may wait anywhere.
        """
        for robot, waits in self.waits.items():
            others = [name for name, target in waits.items() if target == START]
            here = waits.get(recipe.name, START)
            if others and here != START and robot not in self.cell.shared:
                home = self._notation(recipe).home(robot)
                unlike = f"ends with {robot} at {here}; {others[0]} ends with it at {START}"
                yield unlike + f"; write {home} at its end"

    def _notation(self, recipe: Recipe) -> Notation:
        return Notation(cell=self.cell, is_tree=isinstance(recipe, FileRecipe))

    def _say(self, recipe: Recipe, sentences: Iterable[str], place: str | None = None) -> None:
        where = f"{place or _place(recipe)}: {self.cell.name}: {recipe.name}"
        self.sentences |= dict.fromkeys(f"{where} {sentence}" for sentence in sentences)


def _place(recipe: Recipe) -> str | None:
    """The place of a recipe in its file; None for a recipe that no file of the plant has."""
    if isinstance(recipe, FileRecipe):
        return str(recipe.place)
    if not isinstance(recipe, WrittenRecipe):
        return None
    code = recipe.function.__code__
    return f"{code.co_filename}:{code.co_firstlineno}:1"


def _is_own(recipe: Recipe) -> bool:
    """True for a recipe of the plant. Nobody who checks a plant can change a recipe of Arboleda's own."""
    return _place(recipe) is not None and not recipe.is_shipped


def _endless(tree: Behaviour) -> Iterator[tuple[str | None, str]]:
    """The retries that go on for longer than people wait, and that nothing ends earlier.

    Each is a sentence with its place in a file of XML; None for a tree of Python.
    """
    for node in tree.iterate():
        if isinstance(node, Again) and not _is_limited(node):
            if node.times > MOST_TRIES or node.times * node.pause_s > LONGEST_S:
                how_often = f"{node.times:,} times, {node.pause_s:g} s apart"
                yield (
                    None,
                    ENDLESS.format(step=node.decorated.name, how_often=how_often)
                    + AROUND.format(limit=IN_PYTHON),
                )
        elif isinstance(node, FileNode) and not _is_limited(node):
            times = _written_retries(node)
            if times is not None and (times < 0 or times > MOST_TRIES):
                how_often = f"{times:,} times" if times > 0 else "without end"
                yield (
                    str(node.place),
                    ENDLESS.format(step=node.children[0].name, how_often=how_often)
                    + AROUND.format(limit=IN_XML),
                )


def _written_retries(node: FileNode) -> int | None:
    """Tries of a failed step that the file gives a node, -1: for ever; None where it gives no number."""
    if ROUNDS not in node.counts or node.goes_on.name != FAILURE:
        return None
    text = node.ports.texts[node.port]
    return int(text) if text.removeprefix("-").isdecimal() else None


def _is_limited(node: Behaviour) -> bool:
    """True for a step inside a step that ends it after some time, or by a condition."""
    around = node.parent
    if around is None:
        return False
    is_limit = isinstance(around, AtMost) or (isinstance(around, FileNode) and around.is_limit)
    return is_limit or _is_limited(around)
