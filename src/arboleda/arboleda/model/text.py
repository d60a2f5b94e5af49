"""Text of a task, read to an Order; a TextError names the wrong word and what is allowed."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches

from arboleda.model.errors import TextError
from arboleda.model.facts import Value, shown
from arboleda.model.outside import LINE, quoted
from arboleda.model.plant_model import Cell, Link, PlantModel
from arboleda.model.recipe import CELL, Parameter, Recipe, matching
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.task import Order

LONGEST = LINE
FORM = Phrase("text.form", "write {form}, e.g. {example}")
FORMS = Phrase("text.forms", "write {form}, e.g. {example}, or {others}")
TOO_LONG = Phrase("text.too_long", "the task text has {number} characters; at most {most} are read")
EMPTY = Phrase("text.empty", "the task text is empty; {form}")
NEITHER = Phrase("text.neither", "{word} is neither a {first} of {cell} nor {others}; {form}")
NO_RECIPE = Phrase("text.no_recipe", "the task names no recipe of {cell}; there are {there}; {form}")
NO_RECIPE_NAMED = Phrase(
    "text.no_recipe_named",
    "the task names no recipe of {cell}; there are {there}; {form}, or as JSON {example}",
)
ONE_WORD = Phrase("text.one_word", "the task has {number} word; {form}")
WORDS = Phrase("text.words", "the task has {number:,} words; {form}")
ONLY_DRAWN = Phrase(
    "text.only_drawn",
    "{robot} is only drawn (link: none), so {cell} cannot do this; "
    "in the plant file, link: mqtt or link: ros reach a robot",
)
NO_ID = Phrase(
    "text.no_id",
    "{word} is not a task id; after # come 1 to 64 letters, digits, '_', '.' or '-'",
)
OUR_ID = Phrase("text.our_id", "{word} is not a task id; ids that start with t- are made by the plant")
UNKNOWN = Phrase("text.unknown", "{word} is not a {kind} of {where}; there are {there}")
UNKNOWN_BUT_NEAR = Phrase(
    "text.unknown_but_near",
    "{word} is not a {kind} of {where}; there are {there}; did you mean {near}?",
)
NO_CHOICE = Phrase("text.no_choice", "{name} of {where} cannot be {word}; there are {there}")
NO_CHOICE_BUT_NEAR = Phrase(
    "text.no_choice_but_near",
    "{name} of {where} cannot be {word}; there are {there}; did you mean {near}?",
)
TWICE = Phrase("text.twice", "{name} is named twice; {form}")
OUTSIDE = Phrase("text.outside", "{kind} is a number from {lower:g} to {upper:g}, not {word}")
OUTSIDE_WHOLE = Phrase(
    "text.outside_whole", "{kind} is a whole number from {lower:g} to {upper:g}, not {word}"
)
NO_PARAMETER = Phrase("text.no_parameter", "{recipe} of {cell} takes no values, and {word} was given")
NO_VALUE = Phrase("text.no_value", "{recipe} of {cell} needs a value for {names}")
PARAMETER = Phrase("text.parameter", "parameter")
CELL_OR_ROBOT = Phrase("text.cell_or_robot", "cell or {robot}")
RECIPE = Phrase("text.recipe", "recipe")
THIS_PLANT = Phrase("text.this_plant", "this plant")
GROUP_FORM = Phrase(
    "text.group_form", "{word} names several cells; write them with commas and without spaces, e.g. {example}"
)
ID = re.compile(r"[A-Za-z0-9_.-]{1,64}", re.ASCII)
BETWEEN_CELLS = ","


def parse(text: str, plant: PlantModel) -> Order:
    """The order that `text` names in this plant; TextError for anything else."""
    if len(text) > LONGEST:
        raise TextError(TOO_LONG(number=len(text), most=LONGEST))
    words, task_id = _split_id(text.split())
    if not words:
        raise TextError(EMPTY(form=_form(plant)))
    cell, recipe = _cell_and_recipe(words, plant)
    is_named = not recipe.is_default or _is_named(words, cell, recipe)
    read = _by_parameter(words, 2 if is_named else 1, cell, recipe, plant)
    _check_reached(cell, recipe)
    return _order(cell, recipe, read, task_id)


def alternatives(text: str, plant: PlantModel) -> tuple[Order, ...]:
    """The orders of which the plant carries out one: several for a text such as `sis_a,sis_b 0B 7`.

    TextError where one of the cells could not do it.
    """
    words = text.split()
    if len(text) > LONGEST or not words or BETWEEN_CELLS not in words[0]:
        return (parse(text, plant),)
    orders = tuple(parse(" ".join([name, *words[1:]]), plant) for name in _named_cells(words[0], plant))
    names = [order.cell for order in orders]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise TextError(TWICE(name=twice, form=_form(plant)))
    return orders


def example(cell: Cell, recipe: Recipe) -> Order:
    """One order of a recipe: the first word of each parameter, and the last one of the last."""
    return _order(cell, recipe, _example_words(cell, recipe), None)


def _example_words(cell: Cell, recipe: Recipe) -> dict[str, str]:
    words = {each.name: each.words(cell)[0] for each in recipe.parameters}
    for last in recipe.parameters[-1:]:
        words[last.name] = last.words(cell)[-1]
    return words


def spelled(
    plant: PlantModel, *, cell: str, recipe: str = "", values: Mapping[str, Value] | None = None, id: str = ""
) -> str:
    """The text of a task whose values are named; TextError where the plant has no such task.

    `cell` may name several cells, as in a text.
    """
    if BETWEEN_CELLS in cell:
        return _spelled_for_several(plant, _named_cells(cell, plant), recipe, values, id)
    there = _cell(cell, plant, robots=False)
    named = _recipe_of(there, recipe, plant)
    given = values or {}
    _check_names(there, named, tuple(given))
    words = {each.name: _read(there, each, shown(given[each.name])) for each in named.parameters}
    _check_reached(there, named)
    text = _order(there, named, words, None).text
    if not id:
        return text
    number = f"#{id.removeprefix('#')}"
    _split_id([number])
    return f"{text} {number}"


def _spelled_for_several(
    plant: PlantModel, cells: list[str], recipe: str, values: Mapping[str, Value] | None, id: str
) -> str:
    """The text for the first cell, with the names of all; each of them has to be able to do it."""
    texts = [spelled(plant, cell=cell, recipe=recipe, values=values, id=id) for cell in cells]
    names = BETWEEN_CELLS.join(text.split()[0] for text in texts)
    text = " ".join([names, *texts[0].split()[1:]])
    alternatives(text, plant)
    return text


def _named_cells(word: str, plant: PlantModel) -> list[str]:
    """The names in a word such as sis_a,sis_b."""
    names = word.split(BETWEEN_CELLS)
    if not all(names):
        example = BETWEEN_CELLS.join(cell.name for cell in plant.cells[:2])
        raise TextError(GROUP_FORM(word=quoted(word), example=example))
    return names


def _order(cell: Cell, recipe: Recipe, words: Mapping[str, str], id: str | None) -> Order:
    short, full = ([*head, *words.values()] for head in ([cell.name], [cell.name, recipe.name]))
    return Order(
        text=" ".join(short if recipe.goes_unnamed else full),
        short=" ".join(short if recipe.is_default else full),
        cell=cell.name,
        recipe=recipe.name,
        id=id,
        values={each.name: each.value(cell, words[each.name]) for each in recipe.parameters},
    )


def _cell_and_recipe(words: list[str], plant: PlantModel) -> tuple[Cell, Recipe]:
    """The cell that the first word names, and the recipe of the second, or the cell's default."""
    second = words[1] if len(words) > 1 else ""
    by_name = [each for each in plant.recipes if not each.is_default]
    name = matching(second, [each.name for each in by_name])
    meant = [each for each in by_name if each.name == name]
    short = len(words) == 2 and any(each.alone and not each.parameters for each in by_name)
    cell = _cell(words[0], plant, robots=any(each.alone for each in meant) if meant else short)
    default = next((each for each in cell.recipes if each.is_default), None)
    named = next((each for each in meant if each in cell.recipes), None)
    if named is not None:
        return cell, named
    if default is not None and _is_named(words, cell, default):
        return cell, default
    if not second and default is None:
        there = tuple(each.name for each in cell.recipes)
        form = _form_of(cell) if cell.recipes else _form(plant)
        raise TextError(NO_RECIPE(cell=cell.name, there=there, form=form))
    if default is None or meant:
        raise TextError(_unknown(RECIPE(), second, [each.name for each in cell.recipes], cell.name))
    first = default.parameters[0] if default.parameters else None
    if short and first is not None and matching(second, first.words(cell)) is None:
        others = tuple(f"'{each.name}'" for each in cell.recipes if not each.is_default)
        called = first.called() if first.called else first.name
        neither = NEITHER(word=quoted(second), first=called, cell=cell.name, others=others, form=_form(plant))
        raise TextError(neither)
    return cell, default


def _is_named(words: list[str], cell: Cell, recipe: Recipe) -> bool:
    """True where a text names the default recipe of its cell, which it need not do."""
    if len(words) < 2 or matching(words[1], [recipe.name]) is None:
        return False
    return all(first.reads(cell, words[1]) is None for first in recipe.parameters[:1])


def _by_parameter(
    words: list[str], start: int, cell: Cell, recipe: Recipe, plant: PlantModel
) -> dict[str, str]:
    """The word of each parameter, from `start` on: named words such as `dose=5` anywhere, others in order."""
    named: dict[str, str] = {}
    in_order: list[str] = []
    names = [each.name for each in recipe.parameters]
    for word in words[start:]:
        name, equals, value = word.partition("=")
        if equals and name in names:
            if name in named:
                raise TextError(TWICE(name=name, form=_form(plant)))
            named[name] = value
        else:
            in_order.append(word)
    unnamed = [name for name in names if name not in named]
    if len(in_order) != len(unnamed):
        raise TextError((ONE_WORD if len(words) == 1 else WORDS)(number=len(words), form=_form(plant)))
    named |= zip(unnamed, in_order, strict=True)
    return {each.name: _read(cell, each, named[each.name]) for each in recipe.parameters}


def _recipe_of(cell: Cell, word: str, plant: PlantModel) -> Recipe:
    """The recipe of that name; without one the cell's default."""
    names = [each.name for each in cell.recipes]
    default = next((each for each in cell.recipes if each.is_default), None)
    if not word and default is None:
        if not cell.recipes:
            raise TextError(NO_RECIPE(cell=cell.name, there=(), form=_form(plant)))
        form, example = _form_of(cell), named_example(cell)
        raise TextError(NO_RECIPE_NAMED(cell=cell.name, there=tuple(names), form=form, example=example))
    name = matching(word, names) if word or default is None else default.name
    if name is None:
        raise TextError(_unknown(RECIPE(), word, names, cell.name))
    return cell.recipe(name)


def _check_names(cell: Cell, recipe: Recipe, given: tuple[str, ...]) -> None:
    """TextError for a value without a parameter, and for a parameter without a value."""
    names = [each.name for each in recipe.parameters]
    wrong = next((name for name in given if name not in names), None)
    if wrong is not None and not names:
        raise TextError(NO_PARAMETER(recipe=recipe.name, cell=cell.name, word=quoted(wrong)))
    if wrong is not None:
        raise TextError(_unknown(PARAMETER(), wrong, names, recipe.name))
    missing = tuple(name for name in names if name not in given)
    if missing:
        raise TextError(NO_VALUE(recipe=recipe.name, cell=cell.name, names=missing))


def _read(cell: Cell, parameter: Parameter, word: str) -> str:
    """The word as the cell has it."""
    read = parameter.reads(cell, word)
    if read is not None:
        return read
    limits, words = parameter.limits(cell), parameter.words(cell)
    if limits is None and parameter.called:
        raise TextError(_unknown(parameter.called(), word, words, cell.name))
    if limits is None:
        raise TextError(_no_choice(parameter.name, word, words, cell.name))
    called = parameter.called() if parameter.called else parameter.name
    outside = OUTSIDE_WHOLE if limits.whole else OUTSIDE
    raise TextError(outside(word=quoted(word), kind=called, lower=limits.lower, upper=limits.upper))


def _check_reached(cell: Cell, recipe: Recipe) -> None:
    """TextError where the task needs a robot that is only drawn, so that it would never end."""
    robots = cell.robots if recipe.alone is None else (cell.roles[recipe.alone],)
    for robot in robots:
        if robot.link is Link.NONE:
            raise TextError(ONLY_DRAWN(robot=robot.name, cell=cell.name))


def _split_id(words: list[str]) -> tuple[list[str], str | None]:
    if not words or not words[-1].startswith("#"):
        return words, None
    task_id = words[-1][1:]
    if not ID.fullmatch(task_id):
        raise TextError(NO_ID(word=quoted(words[-1])))
    if task_id.startswith("t-"):
        raise TextError(OUR_ID(word=quoted(words[-1])))
    return words[:-1], task_id


def _cell(word: str, plant: PlantModel, *, robots: bool) -> Cell:
    by_name = {cell.name: cell for cell in plant.cells}
    roles = dict.fromkeys(each.alone for each in plant.recipes if each.alone) if robots else {}
    for role in roles:
        by_name |= {cell.roles[role].name: cell for cell in plant.cells if role in cell.roles}
    name = matching(word, by_name)
    if name is None:
        raise TextError(_unknown(_cell_or_robot(roles, plant), word, [*by_name], THIS_PLANT()))
    return by_name[name]


def _form(plant: PlantModel) -> Sentence:
    """The form of tasks, with an example of the first cell that has recipes."""
    cell = next(cell for cell in plant.cells if cell.recipes)
    return _form_among(plant.recipes, cell)


def _form_of(cell: Cell) -> Sentence:
    """The form of the tasks of a cell, with an example."""
    return _form_among(cell.recipes, cell)


def named_example(cell: Cell) -> str:
    """An example of a task of a cell as JSON, its recipe and values by name."""
    (recipe, *_) = sorted(cell.recipes, key=lambda each: not each.is_default)
    values: dict[str, object] = {}
    for each in recipe.parameters:
        word = _example_words(cell, recipe)[each.name]
        value = each.value(cell, word)
        values[each.name] = value if isinstance(value, int | float) and shown(value) == word else word
    return json.dumps({"cell": cell.name, "recipe": recipe.name, "values": values}, ensure_ascii=False)


def _form_among(recipes: Sequence[Recipe], cell: Cell) -> Sentence:
    forms = list(dict.fromkeys(each.form() for each in recipes))
    recipe = next(each for each in recipes if each in cell.recipes)
    shown = example(cell, recipe).text
    if len(forms) == 1:
        return FORM(form=forms[0], example=shown)
    return FORMS(form=forms[0], example=shown, others=tuple(forms[1:]))


def _cell_or_robot(roles: Iterable[str], plant: PlantModel) -> Sentence:
    phrases = {each.alone: each.alone_called for each in plant.recipes}
    robots = tuple(phrase() if (phrase := phrases[role]) else role for role in roles)
    return CELL_OR_ROBOT(robot=robots) if robots else CELL()


def _unknown(kind: Sentence | str, word: str, names: Sequence[str], where: str | Sentence) -> Sentence:
    there = tuple(names)
    near = _nearest(word, there)
    if near is None:
        return UNKNOWN(word=quoted(word), kind=kind, where=where, there=there)
    return UNKNOWN_BUT_NEAR(word=quoted(word), kind=kind, where=where, there=there, near=near)


def _no_choice(name: str, word: str, choices: Sequence[str], where: str) -> Sentence:
    """The sentence that a word is no choice for a parameter, whose name may be any word."""
    there = tuple(choices)
    near = _nearest(word, there)
    if near is None:
        return NO_CHOICE(name=name, word=quoted(word), where=where, there=there)
    return NO_CHOICE_BUT_NEAR(name=name, word=quoted(word), where=where, there=there, near=near)


def _nearest(word: str, names: Sequence[str]) -> str | None:
    near = get_close_matches(word.lower(), [name.lower() for name in names], n=1)
    return matching(near[0], names) if near else None
