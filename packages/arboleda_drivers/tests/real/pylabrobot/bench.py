"""The press as a machine of PyLabRobot: its backend is played by hand, call by call."""

from __future__ import annotations

import asyncio
import itertools
import threading
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from arboleda.runtime.build import App
from arboleda.testing.drivers import Bench, Device
from arboleda.testing.drivers.bench import HALT, LATCH

from ..contract.press import Order, Press, Words, app_of

DRIVER = """
          pylabrobot:
            machine: %s
            options: {key: %d}
            side_by_side: %s
            call_s: 4.0
            timeout_s: 1.0
            poll_s: 0.1
            boot: backend.boots
            refusals: [BusyError]
            facts: {guard: {read: read_guard()}, strokes: {read: backend.strokes}}
            verbs:
              open: {calls: [{call: open}]}
              close: {calls: [{call: close}]}
              press: {calls: [{call: press, arguments: {strokes: $strokes}}]}
              measure: {calls: [{call: measure}], answer: {words: {good: ok, bad: nok}}}
            halt: [{call: halt}]
            latch: [{call: latch}]"""
ANSWERS = {"good": "ok", "bad": "nok"}
QUESTION = "measure"
PLAYED: dict[int, PlayedBackend] = {}
KEYS = itertools.count(1)


class BusyError(Exception):
    """Error of a press that takes no order now."""


class PlayedBackend:
    """The press itself: each call waits for the test, and each question for a press that is there."""

    def __init__(self) -> None:
        self.told: Callable[[Order], None] = lambda order: None
        self.strokes = 0
        self._numbers = itertools.count(1)
        self._lock = threading.Lock()
        self._words = Words()
        self._waiting: dict[int, tuple[str, asyncio.Future[str]]] = {}
        self._halted: set[int] = set()
        self._gone, self._silent = False, False

    @property
    def boots(self) -> int:
        return self._words.boot

    async def setup(self) -> None: ...
    async def stop(self) -> None: ...

    async def guard(self) -> str:
        if self._gone:
            raise ConnectionError("the cable is pulled")
        if self._silent:
            await asyncio.Future[None]()
        return self._words.guard

    async def call(self, word: str) -> str:
        number, future = next(self._numbers), asyncio.get_running_loop().create_future()
        with self._lock:
            self._waiting[number] = (word, future)
        self.told(Order(ref=number, word=word))
        return await future

    async def stop_by(self, word: str) -> None:
        with self._lock:
            self._halted |= self._waiting.keys()
        self.told(Order(ref=None, word=word))

    # The wire of the press.

    def connect(self, told: Callable[[Order], None]) -> PlayedBackend:
        self.told = told
        return self

    def say(self, words: Words) -> None:
        with self._lock:
            booted, self._words = words.boot != self._words.boot, words
            for number, (word, _) in list(self._waiting.items()):
                end = self._end(number, word, words)
                if booted or (number in self._halted and words.state != "moving" and end is None):
                    end = ConnectionResetError("the press has stopped")
                if end is not None:
                    self._resolve(number, end)

    def _end(self, number: int, word: str, words: Words) -> str | Exception | None:
        """The result of a call, or the error that it raises, by the press's words; None while it goes on."""
        if words.rejected is not None and words.rejected[0] == number:
            return BusyError(words.rejected[1])
        if words.failed is not None and words.failed[0] == number:
            return RuntimeError(words.failed[1])
        if words.answered is not None and words.answered[0] == number:
            return ANSWERS[words.answered[1]]
        return word if words.done == number else None

    def _resolve(self, number: int, end: str | Exception) -> None:
        _, future = self._waiting.pop(number)

        def resolve() -> None:
            if not future.done():
                future.set_exception(end) if isinstance(end, Exception) else future.set_result(end)

        loop = future.get_loop()
        if not loop.is_closed():
            loop.call_soon_threadsafe(resolve)

    def vanish(self) -> None:
        with self._lock:
            self._gone = True
            for number in list(self._waiting):
                self._resolve(number, ConnectionError("the cable is pulled"))

    def come_back(self) -> None:
        self._words = Words()
        self._gone = False

    def hush(self) -> None:
        self._silent = True

    def close(self) -> None: ...


class PlayedPress(Press):
    """Its silence is that of its backend; what it says is an exception with these words."""

    def __init__(self, backend: PlayedBackend) -> None:
        super().__init__(backend.connect)
        self._backend = backend

    def rejects(self, ref: Any) -> str:
        super().rejects(ref)
        return "(BusyError: ocupado)"

    def gives_up(self, ref: Any) -> str:
        super().gives_up(ref)
        return "gave up (RuntimeError: atasco)"

    def hush(self) -> None:
        super().hush()
        self._backend.hush()


def press(key: int) -> Any:
    """The press as PyLabRobot has machines: a front end, and a backend behind it."""
    from pylabrobot.machines.backend import MachineBackend
    from pylabrobot.machines.machine import Machine, need_setup_finished

    class Backend(MachineBackend):  # type: ignore[misc]
        """Methods that PyLabRobot asks of every backend, on the played one."""

        async def setup(self) -> None: ...
        async def stop(self) -> None: ...

        @property
        def boots(self) -> int:
            return PLAYED[key].boots

        @property
        def strokes(self) -> int:
            return PLAYED[key].strokes

    class Front(Machine):  # type: ignore[misc]
        """A press among PyLabRobot's machines."""

        @need_setup_finished
        async def read_guard(self) -> str:
            return await PLAYED[key].guard()

        @need_setup_finished
        async def press(self, strokes: int) -> None:
            await PLAYED[key].call("press")

        async def halt(self) -> None:
            await PLAYED[key].stop_by(HALT)

        async def latch(self) -> None:
            await PLAYED[key].stop_by(LATCH)

        @need_setup_finished
        async def open(self) -> None:
            await PLAYED[key].call("open")

        @need_setup_finished
        async def close(self) -> None:
            await PLAYED[key].call("close")

        @need_setup_finished
        async def measure(self) -> str:
            return await PLAYED[key].call(QUESTION)

    return Front(backend=Backend())


def _open(folder: Path, state: Path, *, side_by_side: bool) -> tuple[App, Callable[[App], Device]]:
    key, backend = next(KEYS), PlayedBackend()
    PLAYED[key] = backend
    driver = DRIVER % (f"{__name__}:press", key, str(side_by_side).lower())
    return app_of(folder, state, driver), lambda app: PlayedPress(backend)


BENCH = Bench(open=partial(_open, side_by_side=False))
SIDE_BY_SIDE = Bench(open=partial(_open, side_by_side=True), asks=True)
