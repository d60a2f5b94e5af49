"""Damage to each file of the state that a kill has left: a start is refused, or knows what was told."""

from __future__ import annotations

import random
import shutil
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

from arboleda.model.errors import StartError
from arboleda.model.recording import DAY_S, Limits
from arboleda.recorder.files import FOLDER, parts_in, prune
from arboleda.runtime.state import EPOCH, LOCK, STORE, StateDir
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
NOTHING_IS_OLD_S = Limits().days * DAY_S - 3600.0  # a plant that has run so long deletes no record of its own


def unnoticed(
    state: Path, accepted: Mapping[str, str], ends: Mapping[str, str], dice: random.Random
) -> tuple[int, list[str]]:
    """Number of damages tried, in copies, and those after which a start would know less than people do.

    `accepted` has the ids of all tasks that people know of, `ends` the state in which they know some ended.
    """
    memory = sorted(file.name for file in state.glob(f"{Path(STORE).stem}.[st]*"))
    others = [name for name in (EPOCH, LOCK) if (state / name).exists()]
    records = [f"{FOLDER}/{part.path.name}" for part in parts_in(state / FOLDER)]
    others += records
    damaged = [name for name in (*memory, *others) if name not in records[:-1]]
    silent = []
    for name in damaged:
        for way in WAYS:
            with tempfile.TemporaryDirectory() as place:
                for each in memory if name in memory else others:
                    Path(place, each).parent.mkdir(exist_ok=True)
                    shutil.copy(state / each, Path(place, each))
                way(Path(place, name), dice)
                if name in memory:
                    found = _unknown(Path(place, STORE), accepted, ends)
                else:
                    found = _out_of_order(Path(place), _number_of_start(state))
                silent += [f"{way.__name__} {name}: {each}" for each in found]
    return len(damaged) * len(WAYS), silent


def _number_of_start(state: Path) -> int:
    """The number of the last start; 0 if there was none."""
    return int((state / EPOCH).read_text().split()[-1]) if (state / EPOCH).exists() else 0


def _out_of_order(state: Path, epoch: int) -> list[str]:
    """The trouble of a start after the start `epoch`; nothing if it is refused, or has a higher number and
    goes on with the record."""
    parts = parts_in(state / FOLDER)
    try:
        with StateDir(state) as owner:
            number = owner.next_epoch(int(time.time()))
    except StartError:
        return []
    prune(state / FOLDER, Limits(), NOTHING_IS_OLD_S)
    higher = [] if number > epoch else [f"a start is number {number} after number {epoch}"]
    return higher + ["a start deletes the record"] * (parts_in(state / FOLDER) != parts)


def _unknown(memory: Path, accepted: Mapping[str, str], ends: Mapping[str, str]) -> list[str]:
    lost = sorted(_lost(memory, accepted, ends))
    return [f"a start does not know {', '.join(lost)}"] if lost else []


def _lost(memory: Path, accepted: Mapping[str, str], ends: Mapping[str, str]) -> set[str]:
    """The tasks that a start does not know as people do; none if it is refused."""
    try:
        with Store(memory) as store:
            states = {row.id: row.state for row in store.tasks.select(TaskQuery(limit=None))}
    except StartError:
        return set()
    return {id for id in accepted if id not in states} | {id for id in ends if states.get(id) != ends[id]}
