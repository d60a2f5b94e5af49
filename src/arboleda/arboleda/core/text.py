"""Task text -> Order, or a TextError that names the wrong word and what is allowed."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches

from .errors import TextError
from .model import Cell, Link, PlantModel, Robot
from .outside import LINE, quoted
from .sentence import Phrase, Sentence
from .task import Order, Recipe

LONGEST = LINE
FORM = Phrase("text.form", "write <cell> <path> <station>, e.g. {example}, or <arm or cell> palletizing")
TOO_LONG = Phrase("text.too_long", "the task text has {number} characters; at most {most} are read")
EMPTY = Phrase("text.empty", "the task text is empty; {form}")
NEITHER = Phrase("text.neither", "{word} is neither a path of {cell} nor 'palletizing'; {form}")
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
CELL = Phrase("text.cell", "cell")
CELL_OR_ARM = Phrase("text.cell_or_arm", "cell or arm")
PATH = Phrase("text.path", "path")
STATION = Phrase("text.station", "station")
THIS_PLANT = Phrase("text.this_plant", "this plant")
ID = re.compile(r"[A-Za-z0-9_.-]{1,64}", re.ASCII)


def parse(text: str, plant: PlantModel) -> Order:
    """The order that `text` names in this plant; TextError for anything else."""
    if len(text) > LONGEST:
        raise TextError(TOO_LONG(number=len(text), most=LONGEST))
    words, task_id = _split_id(text.split())
    form = FORM(example=_example(plant))
    if not words:
        raise TextError(EMPTY(form=form))
    if len(words) == 2 and words[1].lower() == Recipe.PALLETIZING.value:
        cell = _cell(words[0], plant, arms=True)
        _check_reached(cell, cell.arm)
        return Order(text=f"{cell.name} palletizing", cell=cell.name, recipe=Recipe.PALLETIZING, id=task_id)
    cell = _cell(words[0], plant, arms=len(words) == 2)
    if len(words) == 2 and _known(words[1], _path_codes(cell)) is None:
        raise TextError(NEITHER(word=quoted(words[1]), cell=cell.name, form=form))
    if len(words) != 3:
        raise TextError((ONE_WORD if len(words) == 1 else WORDS)(number=len(words), form=form))
    return _storage(cell, words[1], words[2], task_id)


def compose(
    *, text: str = "", cell: str = "", recipe: str = "", path: str = "", station: str = "", id: str = ""
) -> str:
    """The text that filled-in fields spell, for `parse` to judge; without a recipe it is storage."""
    stored = recipe.strip().lower() in ("", Recipe.STORAGE.value)
    number = id.strip() and f"#{id.strip().removeprefix('#')}"
    words = [text, cell, "" if stored else recipe, path, station, number]
    return " ".join(word.strip() for word in words if word.strip())


def _storage(cell: Cell, path_word: str, station_word: str, task_id: str | None) -> Order:
    code = _known(path_word, _path_codes(cell))
    if code is None:
        raise TextError(_unknown(PATH, path_word, _path_codes(cell), cell.name))
    stations = [str(number) for number in range(len(cell.stations))]
    if station_word not in stations:
        raise TextError(_unknown(STATION, station_word, stations, cell.name))
    _check_reached(cell, *cell.robots)
    return Order(
        text=f"{cell.name} {code} {station_word}",
        cell=cell.name,
        recipe=Recipe.STORAGE,
        id=task_id,
        path=cell.path(code),
        station=cell.stations[int(station_word)],
    )


def _check_reached(cell: Cell, *robots: Robot) -> None:
    """TextError where the task needs a robot that is only drawn: it would never end."""
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


def _cell(word: str, plant: PlantModel, *, arms: bool) -> Cell:
    by_name = {cell.name: cell for cell in plant.cells}
    if arms:
        by_name |= {cell.arm.name: cell for cell in plant.cells}
    name = _known(word, by_name)
    if name is None:
        raise TextError(_unknown(CELL_OR_ARM if arms else CELL, word, by_name, THIS_PLANT()))
    return by_name[name]


def _path_codes(cell: Cell) -> list[str]:
    return [path.code for path in cell.paths]


def _example(plant: PlantModel) -> str:
    cell = plant.cells[0]
    return f"{cell.name} {cell.paths[0].code} {len(cell.stations) - 1}"


def _known(word: str, names: Iterable[str]) -> str | None:
    """The name that `word` spells, whatever its case; only ASCII words spell names."""
    return next((name for name in names if word.isascii() and name.lower() == word.lower()), None)


def _unknown(kind: Phrase, word: str, names: Iterable[str], where: str | Sentence) -> Sentence:
    there = tuple(names)
    near = get_close_matches(word.lower(), [name.lower() for name in there], n=1)
    hint = _known(near[0], there) if near else None
    if hint is None:
        return UNKNOWN(word=quoted(word), kind=kind(), where=where, there=there)
    return UNKNOWN_BUT_NEAR(word=quoted(word), kind=kind(), where=where, there=there, near=hint)
