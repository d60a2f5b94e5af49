"""Task text -> Order, or a TextError that names the wrong word and what is allowed."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches

from .counting import counted
from .errors import TextError
from .model import Cell, Link, PlantModel, Robot
from .outside import LINE, quoted
from .task import Order, Recipe

LONGEST = LINE
FORM = "write <cell> <path> <station>, e.g. {example}, or <arm or cell> palletizing"
ID = re.compile(r"[A-Za-z0-9_.-]{1,64}", re.ASCII)


def parse(text: str, plant: PlantModel) -> Order:
    """The order that `text` names in this plant; TextError for anything else."""
    if len(text) > LONGEST:
        raise TextError(f"the task text has {len(text)} characters; at most {LONGEST} are read")
    words, task_id = _split_id(text.split())
    form = FORM.format(example=_example(plant))
    if not words:
        raise TextError(f"the task text is empty; {form}")
    if len(words) == 2 and words[1].lower() == Recipe.PALLETIZING.value:
        cell = _cell(words[0], plant, arms=True)
        _check_reached(cell, cell.arm)
        return Order(text=f"{cell.name} palletizing", cell=cell.name, recipe=Recipe.PALLETIZING, id=task_id)
    cell = _cell(words[0], plant, arms=len(words) == 2)
    if len(words) == 2 and _known(words[1], _path_codes(cell)) is None:
        raise TextError(f"{quoted(words[1])} is neither a path of {cell.name} nor 'palletizing'; {form}")
    if len(words) != 3:
        raise TextError(f"the task has {counted(len(words), 'word')}; {form}")
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
        raise TextError(_unknown("path", path_word, _path_codes(cell), cell.name))
    stations = [str(number) for number in range(len(cell.stations))]
    if station_word not in stations:
        raise TextError(_unknown("station", station_word, stations, cell.name))
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
            sentence = f"{robot.name} is only drawn (link: none), so {cell.name} cannot do this"
            raise TextError(f"{sentence}; in the plant file, link: mqtt or link: ros reach a robot")


def _split_id(words: list[str]) -> tuple[list[str], str | None]:
    if not words or not words[-1].startswith("#"):
        return words, None
    task_id = words[-1][1:]
    if not ID.fullmatch(task_id):
        allowed = "1 to 64 letters, digits, '_', '.' or '-'"
        raise TextError(f"{quoted(words[-1])} is not a task id; after # come {allowed}")
    if task_id.startswith("t-"):
        raise TextError(f"{quoted(words[-1])} is not a task id; ids that start with t- are made by the plant")
    return words[:-1], task_id


def _cell(word: str, plant: PlantModel, *, arms: bool) -> Cell:
    by_name = {cell.name: cell for cell in plant.cells}
    if arms:
        by_name |= {cell.arm.name: cell for cell in plant.cells}
    name = _known(word, by_name)
    if name is None:
        raise TextError(_unknown("cell or arm" if arms else "cell", word, by_name, "this plant"))
    return by_name[name]


def _path_codes(cell: Cell) -> list[str]:
    return [path.code for path in cell.paths]


def _example(plant: PlantModel) -> str:
    cell = plant.cells[0]
    return f"{cell.name} {cell.paths[0].code} {len(cell.stations) - 1}"


def _known(word: str, names: Iterable[str]) -> str | None:
    """The name that `word` spells, whatever its case; only ASCII words spell names."""
    return next((name for name in names if word.isascii() and name.lower() == word.lower()), None)


def _unknown(kind: str, word: str, names: Iterable[str], where: str) -> str:
    names = list(names)
    near = get_close_matches(word.lower(), [name.lower() for name in names], n=1)
    hint = f"; did you mean {_known(near[0], names)}?" if near else ""
    return f"{quoted(word)} is not a {kind} of {where}; there are {', '.join(names)}{hint}"
