"""Store of a plant's memory: a file in its state directory, or a database that several hosts reach."""

from __future__ import annotations

from pathlib import Path

from arboleda.model.errors import StartError
from arboleda.store.leadership import Leaders, Leadership
from arboleda.store.plant_memory import PlantMemory
from arboleda.store.schemes import databases
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import History, TaskHistory

from .state import STORE


def memory_of(store: str, state: Path, plant: str) -> PlantMemory:
    """The memory of a plant: in the database `store`, or in `state` if that is ""; StartError."""
    return databases(store).memory(store, plant) if store else Store(state / STORE, plant)


def history_of(store: str, state: Path, plant: str, *, is_checked: bool = False) -> History:
    """The reader of the tasks there. A file is not checked for its owner if `plant` is "", nor for damage if
    it `is_checked` already."""
    if store:
        return databases(store).history(store, plant)
    return TaskHistory(state / STORE, plant, is_checked=is_checked)


def leadership_of(store: str, plant: str) -> Leadership:
    """The leadership of that plant in its database; StartError if `store` is none."""
    if not store:
        raise StartError(
            "This plant's memory is a file, which one process of one host has: give it a database with"
            " `store:` in its plant file, or with --store."
        )
    return databases(store).leadership(store, plant)


def leaders_of(store: str) -> Leaders:
    """The leaders of all plants of a database; StartError."""
    return databases(store).leaders(store)
