"""What a plant has written is synced in a thread; only some of it, and only commands, wait for that."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from arboleda.model.errors import ArboledaError
from arboleda.runtime.parts.durability import Durability
from arboleda.store.sqlite import Store

from ..patience import SOON_S


class Disk(Store):
    """A memory whose syncs are counted, may hang, and may fail."""

    def __init__(self) -> None:
        super().__init__(Path(":memory:"))
        self.syncs = 0
        self.folders: list[str] = []  # the threads that folded the log
        self.reached, self.let_go = threading.Event(), threading.Event()
        self.let_go.set()
        self.error: ArboledaError | None = None

    def sync(self) -> None:
        self.reached.set()
        assert self.let_go.wait(SOON_S)
        if self.error is not None:
            raise self.error
        self.syncs += 1

    def fold(self) -> None:
        self.folders.append(threading.current_thread().name)


class People:
    """Those who are told, and what befell the plant."""

    def __init__(self) -> None:
        self.told: list[tuple[str, Exception | None]] = []
        self.failures: list[Exception] = []
        self.all_told = threading.Event()

    def tell(self, message: str, failure: Exception | None) -> None:
        self.told.append((message, failure))
        if message == "last":
            self.all_told.set()
        if message == "raise":
            raise ValueError(message)


@pytest.fixture
def disk() -> Disk:
    return Disk()


@pytest.fixture
def people() -> People:
    return People()


@pytest.fixture
def durability(disk: Disk, people: People) -> Iterator[Durability]:
    made = Durability(disk, people.tell, people.failures.append)
    yield made
    disk.let_go.set()
    made.stop()


def test_what_is_written_while_a_sync_is_under_way_is_not_durable_by_that(
    durability: Durability, disk: Disk, people: People
) -> None:
    disk.let_go.clear()
    durability.start()
    durability.wrote(precedes_commands=False)
    durability.tell("first")
    durability.wake()
    assert disk.reached.wait(SOON_S)
    durability.wrote(precedes_commands=False)
    durability.tell("last")
    assert not durability.reach(1, 0.0) and people.told == []
    disk.let_go.set()
    assert people.all_told.wait(SOON_S)
    assert people.told == [("first", None), ("last", None)]
    assert disk.syncs == 2 and durability.reach(2, 0.0)


def test_the_thread_folds_the_log_and_who_waits_for_a_sync_does_not(
    durability: Durability, disk: Disk
) -> None:
    durability.wrote(precedes_commands=True)
    durability.let_commands_leave()
    assert disk.folders == []
    durability.start()
    durability.wrote(precedes_commands=False)
    durability.wake()
    assert durability.reach(2, SOON_S)
    durability.stop()
    assert set(disk.folders) == {"durability"}


def test_what_is_left_at_the_end_is_synced_and_told(
    durability: Durability, disk: Disk, people: People
) -> None:
    disk.let_go.clear()
    durability.start()
    durability.wrote(precedes_commands=False)
    durability.tell("last")
    disk.let_go.set()
    durability.stop()
    assert people.told == [("last", None)]
