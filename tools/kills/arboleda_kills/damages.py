"""Damage to each file of the memory that a kill has left: a start is refused, or knows what was told."""

from __future__ import annotations

import random
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path

from arboleda.model.errors import StartError
from arboleda.runtime.state import STORE
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import TaskQuery


def flip(file: Path, dice: random.Random) -> None:
    content = bytearray(file.read_bytes())
    if content:
        content[dice.randrange(len(content))] ^= 1 << dice.randrange(8)
    file.write_bytes(content)


def cut(file: Path, dice: random.Random) -> None:
    file.write_bytes(file.read_bytes()[: dice.randrange(file.stat().st_size + 1)])


def remove(file: Path, _: random.Random) -> None:
    file.unlink()


WAYS = (flip, cut, remove)


def unnoticed(
    state: Path, accepted: Mapping[str, str], ends: Mapping[str, str], dice: random.Random
) -> tuple[int, list[str]]:
    """How many damages were tried, in copies, and those after which a start would know less than people do.

    `accepted` has the ids of all tasks that people know of, `ends` the state in which they know some ended.
    """
    names = sorted(file.name for file in state.glob(f"{Path(STORE).stem}.[st]*"))
    silent = []
    for name in names:
        for way in WAYS:
            with tempfile.TemporaryDirectory() as place:
                for each in names:
                    shutil.copy(state / each, place)
                way(Path(place, name), dice)
                if lost := _lost(Path(place, STORE), accepted, ends):
                    silent.append(f"{way.__name__} {name}: a start does not know {', '.join(sorted(lost))}")
    return len(names) * len(WAYS), silent


def _lost(memory: Path, accepted: Mapping[str, str], ends: Mapping[str, str]) -> set[str]:
    """The tasks that a start does not know as people do; none if it is refused."""
    try:
        with Store(memory) as store:
            states = {row.id: row.state for row in store.tasks.select(TaskQuery(limit=None))}
    except StartError:
        return set()
    return {id for id in accepted if id not in states} | {id for id in ends if states.get(id) != ends[id]}
