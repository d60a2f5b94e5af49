"""Store of a plant's memory: a file in its state directory, or a database that several hosts reach."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from arboleda.model.errors import StartError
from arboleda.store.plant_memory import PlantMemory
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import History, TaskHistory

from . import invocation
from .state import STORE

if TYPE_CHECKING:
    from arboleda.store.postgres.leadership import Leadership


def memory_of(store: str, state: Path, plant: str) -> PlantMemory:
    """The memory of a plant: in the database `store`, or in `state` if that is ""; StartError."""
    if not store:
        return Store(state / STORE, plant)
    refuse_without_library()
    from arboleda.store.postgres.memory import PostgresMemory

    return PostgresMemory(store, plant)


def history_of(store: str, state: Path, plant: str, *, is_checked: bool = False) -> History:
    """The reader of the tasks there. A file is not checked for its owner if `plant` is "", nor for damage if
    it `is_checked` already."""
    if not store:
        return TaskHistory(state / STORE, plant, is_checked=is_checked)
    refuse_without_library()
    from arboleda.store.postgres.history import PostgresHistory

    return PostgresHistory(store, plant)


def leadership_of(store: str, plant: str) -> Leadership:
    """The leadership of that plant in its database; StartError if `store` is none."""
    if not store:
        raise StartError(
            "This plant's memory is a file, which one process of one host has: give it a database with"
            " `store:` in its plant file, or with --store."
        )
    refuse_without_library()
    from arboleda.store.postgres.leadership import Leadership

    return Leadership(store, plant)


def refuse_without_library() -> None:
    """Raise StartError if the extra is not installed."""
    try:
        import psycopg  # noqa: F401 - it is an extra
    except ImportError as error:
        raise StartError(
            "A store in PostgreSQL needs the library psycopg: type"
            f" `{invocation.python()} -m pip install 'arboleda[postgres]'` ({error})"
        ) from error
