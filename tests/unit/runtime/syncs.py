"""A memory whose syncs a test decides, and those who wait for them."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.patience import SOON_S

from arboleda.model.errors import ArboledaError
from arboleda.runtime.parts.durability import Durability
from arboleda.store.sqlite import Store


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
