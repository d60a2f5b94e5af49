"""The press behind a PLC, whatever that speaks: it is read again and again, and its program is the test."""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from arboleda.runtime.build import App
from arboleda.testing.drivers import Bench, Device

from ..contract.press import Order, Press, Words, app_of

VERBS = {1: "open", 2: "close", 3: "press", 4: "measure"}
STATES = {"stopped": 0, "moving": 1, "latched": 2}
ANSWERS = {"good": 1, "bad": 2}


class Server(Protocol):
    """The PLC's end of the line."""

    def start(self) -> int: ...
    def stop(self) -> None: ...


class PlayedPlc(ABC):
    """A PLC that shows the words of the press; `told` gets its orders."""

    def __init__(self) -> None:
        self.told: Callable[[Order], None] = lambda order: None
        self._changed = threading.Lock()
        self._silent, self._closed = threading.Event(), threading.Event()
        self.say(Words())  # a driver that reads zeros first finds a board that has booted then
        self.port = 0
        self.come_back()

    @abstractmethod
    def _serve(self, port: int) -> Server:
        """A server of this PLC; port 0 takes a free one."""

    @abstractmethod
    def say(self, words: Words) -> None:
        """Show these words from now on."""

    def connect(self, told: Callable[[Order], None]) -> PlayedPlc:
        self.told = told
        return self

    def vanish(self) -> None:
        self._server.stop()

    def come_back(self) -> None:
        self._server = self._serve(self.port)
        self.port = self._server.start()

    def hush(self) -> None:
        """A PLC that is asked and does not answer."""
        self._silent.set()

    def close(self) -> None:
        self._closed.set()
        self._server.stop()


def numbers(words: Words) -> dict[str, int]:
    """Words of the press as the numbers that a PLC shows."""
    pairs = (words.rejected, words.failed, words.answered)
    rejected, failed, answered = (pair or (0, "") for pair in pairs)
    return {
        "boot": words.boot,
        "state": STATES[words.state],
        "accepted": words.accepted or 0,
        "done": answered[0] if words.answered is not None else words.done or 0,
        "rejected": rejected[0],
        "reason": 1,
        "failed": failed[0],
        "failure": 1,
        "guard": int(words.guard == "closed"),
        "strokes": 0,
        "seen": ANSWERS.get(answered[1], 1),
    }


class PolledPress(Press):
    """Its silence is that of its PLC."""

    def __init__(self, plc: PlayedPlc) -> None:
        super().__init__(plc.connect)
        self._plc = plc

    def hush(self) -> None:
        super().hush()
        self._plc.hush()


def bench(made: Callable[[], PlayedPlc], driver: str, takes: str, device_threads: str | None = None) -> Bench:
    """The press behind a PLC of that protocol; `driver` is its mapping, with a place for the port."""

    def opened(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
        plc = made()
        return app_of(folder, state, driver % plc.port), lambda app: PolledPress(plc)

    return Bench(open=opened, asks=True, takes=takes, device_threads=device_threads)
