"""A press, played by hand over any protocol that has words for what it says: a `Wire`."""

from __future__ import annotations

import queue
import shutil
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

from tests.packages import ROOT

from arboleda.model.messages import MotionState
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load
from arboleda.runtime.build import App
from arboleda.testing.drivers import open_shop
from arboleda.testing.drivers.bench import ASK, HALT, LATCH, OTHER, WORK, Ref

BEAT_S = 0.1
NAME = "press"
EXAMPLE = ROOT / "examples/own_driver"
DRIVER = "{line_tcp: {host: 127.0.0.1, port: 4711}}"
CODES = {"stopped": MotionState.STOPPED, "moving": MotionState.MOVING, "latched": MotionState.STOP_LATCHED}
STOPS = {2: HALT, 1: LATCH, 0: "clear"}
MEANS = {"close": WORK, "open": OTHER, "measure": ASK}
GUARD = {WORK: "closed", OTHER: "open"}


def text(folder: Path, driver: str) -> str:
    """The plant file of the example, with the press behind this driver; the folder gets what it uses."""
    shutil.copytree(EXAMPLE, folder)
    found = (folder / "plant.yaml").read_text("utf-8")
    assert DRIVER in found
    return found.replace(DRIVER, driver)


def plant(folder: Path, driver: str) -> PlantModel:
    """The plant of the example, with the press behind this driver."""
    written = text(folder, driver)
    (folder / "plant.yaml").write_text(written, "utf-8")
    return load(folder / "plant.yaml")


def app_of(folder: Path, state: Path, driver: str, **more: Any) -> App:
    """The same with the recipes of the contract, built."""
    works = {"work": "close()", "other": "open()", "ask": "measure()"}
    return open_shop(folder, state, text(folder, driver), device=NAME, **works, **more)


@dataclass(frozen=True, kw_only=True)
class Order:
    """Order of the press: a verb or a stop, as its protocol has it."""

    ref: Ref
    word: str


@dataclass(frozen=True, kw_only=True)
class Words:
    """Words of the press; ids are the refs of orders."""

    state: str = "stopped"
    guard: str = "open"
    boot: int = 1
    accepted: Ref = None
    done: Ref = None
    rejected: tuple[Ref, str] | None = None
    failed: tuple[Ref, str] | None = None
    answered: tuple[Ref, str] | None = None


class Wire(Protocol):
    """One protocol; what connects it is given who gets each order, in any thread."""

    def say(self, words: Words) -> None: ...
    def vanish(self) -> None: ...
    def come_back(self) -> None: ...
    def close(self) -> None: ...


class Press:
    """It says its words again and again, until it is hushed."""

    def __init__(self, connect: Callable[[Callable[[Order], None]], Wire]) -> None:
        self._words = Words()
        self.orders: queue.Queue[tuple[str, Ref]] = queue.Queue()
        self._works: dict[Ref, str] = {}
        self._quiet, self._ending = threading.Event(), threading.Event()
        self._wire = connect(self._hear)
        self._thread = threading.Thread(target=self._speak, name="press", daemon=True)
        self._thread.start()

    def accepts(self, ref: Ref) -> None:
        self._say(accepted=ref, state="moving" if self._works[ref] in GUARD else self._words.state)

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        guard = GUARD[self._works[ref]] if there else self._words.guard
        self._say(done=ref, state="stopped", guard=guard)

    def rejects(self, ref: Ref) -> str:
        self._say(rejected=(ref, "ocupado"))
        return "(ocupado)"

    def gives_up(self, ref: Ref) -> str:
        self._say(failed=(ref, "atasco"), state="stopped")
        return "gave up (atasco)"

    def rests(self) -> None:
        self._say(state="stopped")

    def answers(self, ref: Ref, word: str) -> None:
        self._say(answered=(ref, word))

    def hush(self) -> None:
        self._quiet.set()

    def boots(self) -> None:
        self._words = Words(boot=self._words.boot + 1)
        self._wire.say(self._words)

    def vanish(self) -> None:
        self._quiet.set()
        self._wire.vanish()

    def come_back(self) -> None:
        self._words = Words()
        self._wire.come_back()
        self._quiet.clear()

    def latches(self) -> None:
        self._say(state="latched")

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self._wire.close()

    def _hear(self, order: Order) -> None:
        word = self._works[order.ref] = MEANS.get(order.word, order.word)
        self.orders.put((word, order.ref))

    def _say(self, **words: Any) -> None:
        self._words = replace(self._words, **words)
        self._wire.say(self._words)

    def _speak(self) -> None:
        while not self._ending.wait(BEAT_S):
            if not self._quiet.is_set():
                self._wire.say(self._words)
