"""Task texts by a grammar of our own: what is taken, as what, and what is refused."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from arboleda.engine.inspection import is_ending
from arboleda.model.messages import TaskChanged, TaskRequest, TaskState
from arboleda.model.plant_model import Cell, Link, PlantModel
from arboleda.model.sentence import Value
from arboleda.model.text import FORM, UNKNOWN_BUT_NEAR
from arboleda.recipes import Parameter, Recipe

from ..task_words import task_words
from .invariant import Look, Trigger, invariant

LONGEST = 200
ID = re.compile(r"#(?!t-)[A-Za-z0-9_.-]{1,64}", re.ASCII)


@dataclass(frozen=True, kw_only=True)
class Meaning:
    """One meaning of a text: its cell and recipe, its words as the plant tells them, and its id."""

    cell: str
    recipe: Recipe
    words: str
    id: str | None


class Unsure(Exception):
    """Nothing is written here of what a text would mean."""


@invariant(Trigger.ASKED)
def texts_mean_what_they_say(look: Look) -> Iterator[str]:
    """A task text is taken where it names what the plant has and its cell has room, and only there."""
    requests = look.moment.requests
    if len(requests) != 1 or not isinstance(requests[0], TaskRequest) or requests[0].trigger:
        return
    try:
        meant = _all_meant(look.world.offers, requests[0].text)
    except Unsure:
        return
    if meant:
        yield from _wrongly_taken(look, requests[0].text, meant)
        return
    if not look.record.tasks.refused:
        yield f"{requests[0].text[:60]!r} means nothing, and was taken"
    yield from _unhelpful(look)


def _wrongly_taken(look: Look, text: str, meant: list[Meaning]) -> Iterator[str]:
    record = look.record
    changes = [change.message for change in record.tasks.changes if change.before is None or change.answer]
    refused = record.tasks.refused > 0
    queued = {each.name: each.queued for each in record.before_requests.cells}
    full = [each for each in meant if queued[each.cell] >= look.world.offers.cell(each.cell).queue_limit]
    id = meant[0].id
    known = id is not None and id in record.before_requests.ids
    ends = is_ending(look.world.plant)
    if not known and refused is not (ends or len(full) == len(meant)):
        word = "refused" if refused else "taken"
        yield f"{text!r} was {word}, so many tasks wait: {queued}"
    allowed = {(each.cell, each.words) for each in meant}
    if refused:
        return
    if not any((task_change.cell, task_change.text) in allowed for task_change in changes):
        yield f"{text!r} was taken as {[task_change.text for task_change in changes]}"
    if id is not None and not any(task_change.task == id for task_change in changes):
        yield f"{text!r} has another id: {[task_change.task for task_change in changes]}"
    if not known and not any(task_change.state is TaskState.QUEUED for task_change in changes):
        yield f"{text!r} was taken, and nobody says that it waits"


def _unhelpful(look: Look) -> Iterator[str]:
    """Sentences on refusals whose example is no task, or whose hint is not there."""
    for message in look.moment.sent:
        if not isinstance(message, TaskChanged) or message.state is not TaskState.REFUSED:
            continue
        for part in message.sentence.parts():
            example = str(part.values["example"]) if part.phrase is FORM else None
            if example is not None and not _is_last(look.world.offers, example):
                yield f"{example!r} is given as an example, and is no task"
            if part.phrase is UNKNOWN_BUT_NEAR and part.values["near"] not in _list(part.values["there"]):
                yield f"{message.sentence!r} hints at what there is not"


def _list(value: Value) -> tuple[Value, ...]:
    return value if isinstance(value, tuple) else (value,)


def _is_last(model: PlantModel, text: str) -> bool:
    """True for a task whose last word is the last one that it can be."""
    try:
        meant = _meant(model, text)
        if meant is None or not meant.recipe.parameters:
            return meant is not None
        last = _words(model.cell(meant.cell), meant.recipe.parameters[-1])[-1]
    except Unsure:
        return True
    return meant.words.endswith(f" {last}")


def _all_meant(model: PlantModel, text: str) -> list[Meaning]:
    """The meanings of a text in the cells that it names with commas; empty if one of them cannot do it."""
    names, space, rest = text.strip().partition(" ")
    if len(text) > LONGEST:
        return []
    meant = [_meant(model, f"{name}{space}{rest}") for name in names.split(",")]
    found = [each for each in meant if each is not None]
    return found if len({each.cell for each in found}) == len(meant) else []


def _meant(model: PlantModel, text: str) -> Meaning | None:
    """The meaning of a text; None where it means no task. Unsure of one with numbers or with named values."""
    words, id = text.split(), None
    if len(text) > LONGEST:
        return None
    if words and words[-1].startswith("#"):
        if not ID.fullmatch(words[-1]):
            return None
        id = words.pop()[1:]
    if any("=" in word for word in words):
        raise Unsure
    if not words:
        return None
    for cell in model.cells:
        for recipe in cell.recipes:
            if (
                _is_called(words[0], cell, recipe)
                and (values := _values(cell, recipe, words[1:])) is not None
            ):
                is_short = recipe.is_default and recipe.parameters
                head = [cell.name] if is_short else [cell.name, recipe.name]
                return Meaning(cell=cell.name, recipe=recipe, words=" ".join([*head, *values]), id=id)
    return None


def _is_called(word: str, cell: Cell, recipe: Recipe) -> bool:
    """True for the name of a cell, or of the robot that does this alone, if a task needs no word more."""
    robot = cell.roles.get(recipe.alone or "")
    is_robot = robot is not None and _is(word, robot.name)
    is_called = is_robot or _is(word, cell.name)
    if is_called and any(each.link is Link.NONE for each in cell.robots):
        raise Unsure  # nobody can do it
    if is_robot and (recipe.parameters or recipe.is_default):
        raise Unsure
    return is_called


def _values(cell: Cell, recipe: Recipe, words: Sequence[str]) -> list[str] | None:
    """The words for the parameters of a recipe, as its cell has them; None where they are none.

    The name of a default recipe may be left out; a word that another recipe is called by means that one.
    """
    if words and _is(words[0], recipe.name):
        words = words[1:]
    elif not recipe.is_default or any(_is(words[0], each.name) for each in cell.recipes if words):
        return None
    if len(words) != len(recipe.parameters):
        return None
    read = [_read(cell, each, word) for each, word in zip(recipe.parameters, words, strict=True)]
    found = [word for word in read if word is not None]
    return found if len(found) == len(read) else None


def _read(cell: Cell, parameter: Parameter, word: str) -> str | None:
    return next((each for each in _words(cell, parameter) if _is(word, each)), None)


def _words(cell: Cell, parameter: Parameter) -> Sequence[str]:
    if parameter.limits(cell) is not None:
        raise Unsure
    return task_words(cell, parameter)


def _is(word: str, name: str) -> bool:
    """True for a word that spells a name; other letters than ASCII never spell one of ASCII."""
    return word.casefold() == name.casefold() and (word.isascii() or not name.isascii())


TEXTS = (texts_mean_what_they_say,)
