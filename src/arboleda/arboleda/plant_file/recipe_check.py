"""Recipes built in every cell for every combination of their parameters, before anything can move."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations as pairs
from pathlib import Path

from py_trees import behaviours, decorators, timers
from py_trees.behaviour import Behaviour

from arboleda.engine import Act, Context, Plant
from arboleda.model.commands import Work
from arboleda.model.errors import ConfigError
from arboleda.model.orders import orders
from arboleda.model.outside import plain
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.recipe import Parameter, Recipe, spelling
from arboleda.model.task import Order
from arboleda.model.tree_nodes import nodes_of
from arboleda.recipes.errors import RoleError
from arboleda.recipes.of_files import FileNode, FileRecipe, NoDeviceError, TreeMistakes
from arboleda.recipes.of_files import Place as FilePlace
from arboleda.views import tree_view

from . import drivers, extensions, own_recipes
from .document import Document, Place, choice, closest, misnamed, nearest, shown
from .loader import plant_of
from .lost_steps import Made
from .own_recipes import SECTION
from .python_uses import LONGEST, PythonUses, SourceSpot, Watch, error_text
from .recipe_trial import TrialResult

HOW_TO_CHOOSE = "; give it to a node that lists its values, or its port a type: int, double, bool"
WAIT = "cell.wait(seconds)"
DO_IT = "let it stand in what the recipe returns, as in work(...)"
USE_IT = "let it stand in what the recipe returns, or delete it"
AT_MOST = "becomes(..., at_most_s=...) of a device"
NOT_WOKEN: Mapping[type[Behaviour], str] = {
    timers.Timer: WAIT,
    behaviours.Periodic: WAIT,
    behaviours.Running: AT_MOST,
    behaviours.StatusQueue: WAIT,
    behaviours.SuccessEveryN: WAIT,
    behaviours.TickCounter: WAIT,
    behaviours.WaitForBlackboardVariable: AT_MOST,
    behaviours.WaitForBlackboardVariableValue: AT_MOST,
    decorators.Repeat: "cell.repeat(step, times)",
    decorators.Retry: "cell.retry(step, times=2)",
    decorators.Timeout: "cell.timeout(step, seconds)",
}
"""By the class of a node that asks a clock, or waits to be ticked: what a recipe takes instead.

The engine ticks a tree when something happens, so such a node would never be ticked again."""


def trial(name: str, content: bytes, folder: Path | None, watch: Watch) -> TrialResult:
    """The problems of a plant file and of its recipes, which are built for each task that they could have.

    The plant's Python files run in this process, whatever they do to it. `recipe_trial` calls this function
    in a process of its own.
    """
    document, result = Document(name, content, folder), TrialResult()

    def tried(cells: Sequence[Cell]) -> dict[str, tuple[Recipe, ...]]:
        trial = RecipeTrial(document=document, used=used, watch=watch)
        result.offers = trial.run(cells)
        result.missed, result.unused = trial.missed, trial.unused
        return {}

    used = own_recipes.imported(document, own_recipes.listed(document), watch)
    plant_of(document, used, tried)
    drivers.driver_uses(document, used)
    extensions.settings_given(document, used)
    result.here, result.elsewhere = document.problems
    return result


@dataclass
class RecipeTrial:
    """Builds the recipes of a plant in its cells, and keeps what each cell offers, and the problems."""

    document: Document
    used: PythonUses
    watch: Watch
    offers: dict[str, list[str]] = field(default_factory=dict)
    misfits: dict[str, list[str]] = field(default_factory=dict)  # by recipe: problems in cells without it
    missed: dict[str, dict[str, str]] = field(default_factory=dict)  # by cell and recipe: why it is missed
    named: dict[str, dict[str, bool]] = field(default_factory=dict)  # by recipe and sentence: always lost
    is_sound: bool = True  # False: there is a problem already from which others may follow

    def run(self, cells: Sequence[Cell]) -> dict[str, list[str]]:
        """The names of the recipes that each cell offers, in their order.

        Where there is a problem already, a cell or a recipe may be missing because it could not be read. Then
        a cell without recipes, and a recipe without cells, are no problem.
        """
        here, elsewhere = self.document.problems
        self.is_sound = not here and self.used.in_trees.issuperset(elsewhere)
        for cell in cells:
            named = self._named(cell)
            names = list(self.used.recipes) if named is None else named
            fitting = [name for name in names if self._fits(cell, self.used.recipes[name], named is not None)]
            self.offers[cell.name] = fitting
            self._check_default(cell, fitting)
        if self.is_sound:
            self._check_all_fit(cells)
        return self.offers

    @property
    def unused(self) -> dict[str, list[str]]:
        """By recipe a sentence, with its place, for each named step that no task of the recipe does."""
        return {
            recipe: [sentence for sentence, is_lost in said.items() if is_lost]
            for recipe, said in self.named.items()
        }

    def _check_all_fit(self, cells: Sequence[Cell]) -> None:
        """Keep the problems of recipes that no cell offers, and of cells that offer none."""
        offered = {name for names in self.offers.values() for name in names}
        for name, problems in self.misfits.items():
            if name not in offered:
                self._keep(problems)
        for cell in cells:
            if not (self.offers[cell.name] or cell.recipes) and self._brings_all(offered):
                place = ("cells", cell.name)
                why = "; ".join(self.missed.get(cell.name, {}).values())
                none = 'offers no recipe: none that "uses" brings fits its devices'
                self.document.problem(place, f"{none}{why and f' ({why})'}", at=place)

    def _brings_all(self, offered: Collection[str]) -> bool:
        """True if no misfit is reported yet: another cell offers a recipe, or no file has a recipe."""
        none = self.used.is_whole and not self.used.recipes and self.document.has(SECTION)
        return bool(offered) or none

    def _named(self, cell: Cell) -> list[str] | None:
        """The recipes that the cell names and that exist; None if it names none."""
        place: Place = ("cells", cell.name, "recipes")
        names, recipes = self.document.value(place), self.used.recipes
        if names is None:
            return None
        for index, name in enumerate(names):
            if name in names[:index]:
                self.document.problem((*place, index), f"{shown(name)} is there twice")
            elif name not in recipes and recipes and self._is_mistaken(name, recipes):
                self.document.problem((*place, index), misnamed(name, recipes, ""))
        return [name for name in dict.fromkeys(names) if name in recipes]

    def _check_default(self, cell: Cell, offered: Sequence[str]) -> None:
        place: Place = ("cells", cell.name, "default_recipe")
        name = self.document.value(place)
        if name is not None and name not in offered and offered and self._is_mistaken(name, offered):
            there = f"must be one that the cell offers: {choice(offered)}"
            self.document.problem(place, f"{there}; is {shown(name)}{nearest(name, offered)}")

    def _is_mistaken(self, name: str, names: Collection[str]) -> bool:
        """True if a recipe that is not there is misspelt, and not one of a file with a problem of its own."""
        return self.is_sound or closest(name, names) is not None

    def _fits(self, cell: Cell, recipe: Recipe, named: bool) -> bool:
        """True if the cell names a recipe, or has all that it needs; problems of building its trees are kept.

        A problem that may follow from another one is not told.
        """
        spot = self.used.spot(recipe)
        empty = _without_value(cell, recipe)
        if unfit := empty or _unspellable(cell, recipe):
            absent, found = self._whatever_values(cell, recipe)
            if empty and found:
                unfit = _without_value(cell, recipe, but=_handed_on(recipe))
            if unfit and absent is None and (self.is_sound or not empty):
                found.append(spot.problem(unfit))
            if empty and not named:
                self._miss(cell, recipe, absent or empty, found)
                return False
            self._keep(found)
            return True
        plant = Plant(PlantModel(name="trial", cells=(replace(cell, recipes=(recipe,)),)), epoch=0, now=0.0)
        context = plant.cells[cell.name].context
        problems: dict[str, None] = {}
        for number, order in enumerate(orders(cell, recipe)):
            self.watch(spot, f"building {recipe.name} for {cell.name}")
            try:
                tree_problems = self._look(recipe, order, context)
            except RoleError as error:
                tree_problems = self._absent(recipe, error)
                may_be_there = isinstance(error, NoDeviceError) and not self.used.is_whole
                if number == 0 and not named and not may_be_there:
                    self._miss(cell, recipe, str(error), tree_problems)
                    return False
            problems |= dict.fromkeys(tree_problems)
        self._keep(list(problems))
        return True

    def _look(self, recipe: Recipe, order: Order, context: Context) -> Sequence[str]:
        """The problems of an order's tree, with their places; RoleError if a device is missing."""
        spot = self.used.spot(recipe)
        if self.used.lost is not None:
            self.used.lost.made.clear()
        try:
            tree = recipe.build(order, context)
        except RoleError:
            raise
        except TreeMistakes as error:
            return [plain(line, LONGEST) for line in error.lines]
        except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
            return [
                self.used.where(error, spot).problem(f"{recipe.name} cannot be built: {error_text(error)}")
            ]
        self._note_named(recipe)
        problems = [each.at(spot).problem(f"{recipe.name} {each.why}") for each in _objections(tree)]
        return [*problems, *self._lost(recipe)]

    def _whatever_values(self, cell: Cell, recipe: Recipe) -> tuple[str | None, list[str]]:
        """All that is wrong with a tree of a file, whichever values its parameters have.

        First the sentence that the cell has no device for it, if so.
        """
        if isinstance(recipe, FileRecipe):
            try:
                recipe.check(cell)
            except NoDeviceError as error:
                return str(error), self._absent(recipe, error)
            except TreeMistakes as error:
                return None, [plain(line, LONGEST) for line in error.lines]
        return None, []

    def _absent(self, recipe: Recipe, error: RoleError) -> list[str]:
        """The problems of a recipe for which a cell lacks something.

        Where a file could not be imported, it may have the nodes that no device makes.
        """
        nodes: Sequence[RoleError] = (error,)
        mistakes: Sequence[str] = ()
        if isinstance(error, NoDeviceError):
            nodes, mistakes = (error, *error.others) if self.used.is_whole else (), error.mistakes
        spot = self.used.spot(recipe)
        absent = [self.used.where(each, spot).problem(f"{recipe.name}: {each}") for each in nodes]
        return [*absent, *(plain(line, LONGEST) for line in mistakes)]

    def _lost(self, recipe: Recipe) -> Iterator[str]:
        """Problems of steps without a name that the recipe makes and does nowhere."""
        for made in self.used.lost.lost() if self.used.lost is not None else ():
            sentence = f"{recipe.name} makes the step {made.step.name} and does it nowhere; {DO_IT}"
            yield self._spot(made).problem(sentence)

    def _note_named(self, recipe: Recipe) -> None:
        """Note which named steps stand nowhere in this task. Other tasks of the recipe may do them."""
        lost_in_all = self.named.setdefault(recipe.name, {})
        here: dict[str, bool] = {}
        for made in self.used.lost.made if self.used.lost is not None else ():
            if made.name:
                step = f"{recipe.name} makes the step {made.step.name} as {made.name}"
                said = self._spot(made).problem(f"{step} and does it nowhere; {USE_IT}")
                here[said] = here.get(said, True) and made.is_lost
        lost_in_all |= {said: is_lost and lost_in_all.get(said, True) for said, is_lost in here.items()}

    def _spot(self, made: Made) -> SourceSpot:
        return SourceSpot(file=self.used.files.get(made.file, made.file), line=made.line)

    def _miss(self, cell: Cell, recipe: Recipe, why: str, problems: Sequence[str]) -> None:
        self.misfits.setdefault(recipe.name, []).extend(problems)
        self.missed.setdefault(cell.name, {})[recipe.name] = why

    def _keep(self, problems: Sequence[str]) -> None:
        self.document.keep_those_of(ConfigError(tuple(problems)))


@dataclass(frozen=True, kw_only=True)
class _Objection:
    """Objection to a tree, and the place of its node in a file of XML."""

    why: str
    place: FilePlace | None = None

    def at(self, spot: SourceSpot) -> SourceSpot:
        """The place of the node in its file of XML; `spot` for a tree of Python."""
        if self.place is None:
            return spot
        return SourceSpot(file=self.place.file, line=self.place.mark.line, column=self.place.mark.column)


def _objections(tree: Behaviour) -> Iterator[_Objection]:
    """The objections to a tree that could be built but would never end, or always fail."""
    for device, place in dict.fromkeys(_at_once(tree)):
        instead = "work(...)" if place is None else "a Sequence"
        why = f"has {device} do two things at once, in a parallel; it does one after the other: {instead}"
        yield _Objection(why=why, place=place)
    for node in nodes_of(tree):
        for kind in type(node).__mro__:  # `isinstance` would ask each of their abstract classes
            if kind in NOT_WOKEN:
                instead = NOT_WOKEN[kind]
                why = f"has a py_trees {kind.__name__} ({node.name}), which nothing wakes; take {instead}"
                yield _Objection(why=why)
                break


def _at_once(tree: Behaviour) -> Iterator[tuple[str, FilePlace | None]]:
    """The devices to which two branches of a parallel give work; a device refuses the second.

    Each has the place of the parallel in its file of XML; None in a tree of Python.
    """
    for node in nodes_of(tree):
        branches = [_at_work(child) for child in node.children] if tree_view.kind(node) == "parallel" else []
        for one, other in pairs(branches, 2):
            place = node.place if isinstance(node, FileNode) else None
            yield from ((device, place) for device in sorted(one & other))


def _at_work(branch: Behaviour) -> set[str]:
    """The devices that a part of a tree has do work."""
    commands = [node.make(id="") for node in nodes_of(branch) if isinstance(node, Act)]
    return {command.robot for command in commands if isinstance(command, Work)}


def _handed_on(recipe: Recipe) -> Collection[str]:
    """The parameters that lack a value, perhaps, only because they are given to a node with a mistake."""
    return recipe.handed_on if isinstance(recipe, FileRecipe) else ()


def _without_value(cell: Cell, recipe: Recipe, but: Collection[str] = ()) -> str | None:
    """The sentence that a parameter has no possible value in a cell; None where each has one."""
    for each in recipe.parameters:
        if each.name not in but and not each.words(cell):
            return f"{each.name} of {recipe.name} has no value to choose{_how_to_choose(cell, recipe, each)}"
    return None


def _how_to_choose(cell: Cell, recipe: Recipe, parameter: Parameter) -> str:
    group = recipe.groups.get(parameter.name) if isinstance(recipe, FileRecipe) else parameter.group
    if group is not None:
        return f"; {cell.name} has no targets {shown(group)}"
    return HOW_TO_CHOOSE if isinstance(recipe, FileRecipe) else ""


def _unspellable(cell: Cell, recipe: Recipe) -> str | None:
    """The reason why no task text can name some value of a parameter; None where each can be named."""
    for each in recipe.parameters:
        words = each.words(cell)
        for word in words:
            if not _is_spellable(word):
                rule = "one word of letters, digits and signs, not beginning with #"
                return f"{each.name} of {recipe.name} can be {shown(word)}; in a task it must be {rule}"
        if len({spelling(word) for word in words}) < len(words):
            return f"{each.name} of {recipe.name} has two values that differ in nothing but their case"
    return None


def _is_spellable(word: str) -> bool:
    """True if a task text can have `word` as one of its words, and not as an id."""
    return word.split() == [word] and word.isprintable() and not word.startswith("#")
