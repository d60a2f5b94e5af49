"""What a driver needs to take part in the contract of all drivers: a plant with one device, played by hand.

`BENCHES` in benches.py names them all. The cell of every such plant is `shop`; its recipes are `work` and
`other`, two works that lead elsewhere, and `ask`, a question, where its device can be asked.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from tests.patience import PATIENCE_S

from arboleda.model.messages import TaskChanged, TaskState, Verb
from arboleda.runtime.build import App

WORK, OTHER, ASK = "work", "other", "ask"
HALT, LATCH = "halt", "latch"
OPEN = (TaskState.QUEUED, TaskState.RUNNING)
Ref = Any
"""How the device's protocol names a command."""


class Device(Protocol):
    """A device that does nothing by itself; it says what it last said again and again, until it is hushed."""

    def told(self) -> tuple[str, Ref]:
        """The next order, one of the words above, and how the device names it."""

    def accepts(self, ref: Ref) -> None:
        """It takes the order, and is at work."""

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        """It says that the work is done; `there`: and that it has led where it should."""

    def rejects(self, ref: Ref) -> str:
        """It refuses the order; what of that the plant must say."""

    def gives_up(self, ref: Ref) -> str:
        """The work fails at the device; what of that the plant must say."""

    def rests(self) -> None:
        """It stands still, without a word of any order."""

    def answers(self, ref: Ref, word: str) -> None:
        """It answers a question; only where the bench has `asks`."""

    def hush(self) -> None:
        """It says nothing more, over a connection that stays."""

    def boots(self) -> None:
        """It was off for a moment, knows of no order, and stands still."""

    def vanish(self) -> None:
        """The connection ends, as where a cable is pulled."""

    def come_back(self) -> None:
        """It can be reached again, stands still and knows of no order."""

    def latches(self) -> None:
        """It stands still, and says that it is stopped where it can say so."""

    def close(self) -> None: ...


@dataclass(frozen=True, kw_only=True)
class Bench:
    """`open(folder, state)` makes the plant, and what makes its device once the plant has started."""

    open: Callable[[Path, Path], tuple[App, Callable[[App], Device]]]
    asks: bool = False  # whether its device can be asked
    watches: bool = False  # whether the device, or a driver of others, watches for the plant itself


class Shop:
    """A plant with one device, which is reached by a driver."""

    def __init__(self, app: App) -> None:
        self.app = app
        self.device: Device
        self._changes: queue.Queue[TaskChanged] = queue.Queue()
        self._online: queue.Queue[bool] = queue.Queue()
        self._frozen, self._goes_on = threading.Event(), threading.Event()
        app.listen(self._changes.put)
        app.watch(lambda snapshot: self._online.put(snapshot["robots"][0]["online"]))
        app.watch(self._linger)

    def submit(self, recipe: str, id: str = "t1") -> None:
        self.app.plant.submit(f"shop {recipe} #{id}").result(PATIENCE_S)

    def told(self, word: str) -> Ref:
        """How the device names the next order, which is this one."""
        found, ref = self.device.told()
        assert found == word
        return ref

    def outcome(self, id: str = "t1") -> TaskChanged:
        """The end of a task."""
        while (change := self._changes.get(timeout=PATIENCE_S)).state in OPEN or change.task != id:
            pass
        return change

    def cancel(self) -> None:
        assert self.app.plant.operate(Verb.CANCEL, "shop").result(PATIENCE_S).refusal is None

    def until(self, *, online: bool) -> None:
        """Wait until screens show that the device is heard, or that it is not."""
        while self._online.get(timeout=PATIENCE_S) is not online:
            pass

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
