"""A plant at work with one device that is played by hand, and what the cases of the contract do to both."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partialmethod
from typing import Any, TypeVar

import pytest

from arboleda.model.messages import TaskChanged, TaskState, Verb
from arboleda.runtime.build import App
from arboleda.store.act_table import ActTable
from arboleda.store.plant_memory import PlantMemory
from arboleda.store.task_table import TaskTable

from ..patience import PATIENCE_S
from .bench import Bench, Device, Ref

OPEN = (TaskState.QUEUED, TaskState.RUNNING)
Row = dict[str, Any]
Thing = TypeVar("Thing")


class Shop:
    """A plant with one device, which is reached by a driver."""

    def __init__(self, bench: Bench, app: App) -> None:
        self.bench = bench
        self.app = app
        self.device: Device
        self._changes: queue.Queue[TaskChanged] = queue.Queue()
        self._rows: queue.Queue[Row] = queue.Queue()
        self._frozen, self._goes_on = threading.Event(), threading.Event()
        app.listen(self._changes.put)
        app.watch(lambda snapshot: self._rows.put(snapshot["robots"][0]))
        app.watch(self._linger)

    def submit(self, recipe: str, id: str = "t1") -> None:
        self.app.plant.submit(f"shop {recipe} #{id}").result(PATIENCE_S)

    def told(self, *words: str) -> Ref:
        """The device's name for the next order, which is one of these."""
        found, ref = self.next_order()
        assert found in words
        return ref

    def next_order(self) -> tuple[str, Ref]:
        """The next order of the device."""
        return come(self.device.orders, "the device is told something")

    def outcome(self, id: str = "t1") -> TaskChanged:
        """The end of a task."""
        return come(
            self._changes, f"the task {id} ends", lambda each: each.task == id and each.state not in OPEN
        )

    def cancel(self) -> None:
        assert self.app.plant.operate(Verb.CANCEL, "shop").result(PATIENCE_S).refusal is None

    def until(self, is_so: Callable[[Row], object]) -> Row:
        """The first row of the device with which screens show that this is so."""
        return come(self._rows, "screens show the device so", is_so)

    @contextmanager
    def frozen(self) -> Iterator[None]:
        """The plant's thread does nothing, as in a process that swaps."""
        self._goes_on.clear()
        self._frozen.set()
        try:
            yield
        finally:
            self._frozen.clear()
            self._goes_on.set()

    def _linger(self, snapshot: object) -> None:
        """Called in the plant's thread, once a second at least."""
        if self._frozen.is_set():
            self._goes_on.wait(PATIENCE_S)


def come(
    things: queue.Queue[Thing], what: str, is_it: Callable[[Thing], object] = lambda each: True
) -> Thing:
    """The first of these things that is it."""
    ends = time.monotonic() + PATIENCE_S
    while (left := ends - time.monotonic()) > 0:
        with suppress(queue.Empty):
            if is_it(found := things.get(timeout=left)):
                return found
    pytest.fail(f"waited for {PATIENCE_S:g} s until {what} (ARBOLEDA_PATIENCE_S sets how long)")


@contextmanager
def hung_disk(patch: pytest.MonkeyPatch) -> Iterator[None]:
    """Nothing that is written to the plant's memory comes back."""
    goes_on = threading.Event()

    def late(table: object, write: Any, *values: Any, **named: Any) -> None:
        goes_on.wait(PATIENCE_S)
        write(table, *values, **named)

    for owner in (PlantMemory, ActTable, TaskTable):
        patch.setattr(owner, "keep", partialmethod(late, owner.keep))
    try:
        yield
    finally:
        goes_on.set()
