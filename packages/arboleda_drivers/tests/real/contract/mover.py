"""A device that goes to places, played by hand: its plant, and what all that play one have in common."""

from __future__ import annotations

import queue
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from pathlib import Path

from arboleda.runtime.build import App
from arboleda.testing.drivers import Device, open_shop
from arboleda.testing.drivers.bench import HALT, LATCH, OTHER, WORK, Ref

from .tcp_ports import Ports

Opened = tuple[App, Callable[[App], Device]]
HOME = "home"
WORDS = (HOME, WORK, OTHER)  # in the order of the places
ARM_DEG = ((0, 0, 0, 0, 0, 0), (10, 20, -30, 0, 5, 0), (5, 0, 0, 0, 0, 0))
FRAME_S = 0.02
PLANT = """
name: shop
uses: [recipes.py]
cells:
  shop:
    devices:
      {device}: {{{keys}}}
    targets:
      home: {{{device}: {{{unit}: {places[0]}}}}}
      a: {{{device}: {{{unit}: {places[1]}}}}}
      b: {{{device}: {{{unit}: {places[2]}}}}}
"""


def plant(device: str, keys: str, unit: str, places: Sequence[object]) -> str:
    """The plant of a device with these keys; the places are home, where one work leads, and the other."""
    shown = [[*each] if isinstance(each, tuple) else each for each in places]
    return PLANT.format(device=device, keys=keys, unit=unit, places=shown)


def arm(driver: str, keys: str = "") -> str:
    """The plant of an arm of six joints behind this driver."""
    return plant("arm", f"kind: arm, model: cr10a, {keys}driver: {driver}", "deg", ARM_DEG)


def app_of(
    folder: Path,
    state: Path,
    text: str,
    device: str,
    works: tuple[str, str] = ('"a"', '"b"'),
    kinds: str = "",
) -> App:
    """The plant, built; `works`: where the device goes, `kinds`: what its recipes' file begins with."""
    work, other = (f"go({each})" for each in works)
    return open_shop(folder, state, text, device=device, work=work, other=other, python=kinds)


class PlayedMover:
    """Its moves wait for the test, but those home, which it does at once until it was away."""

    def __init__(self) -> None:
        self.orders: queue.Queue[tuple[str, Ref]] = queue.Queue()
        self._homes, self._stop_word = True, HALT  # its protocol has one word for both stops

    def answers(self, ref: Ref, word: str) -> None:
        raise AssertionError("what moves is asked nothing")

    def rests(self) -> None:
        """It stands at the place where it was told to stop."""

    def latches(self) -> None:
        self.rests()

    def _is_made(self, word: str, ref: Ref) -> bool:
        """True for a move that is made at once; any other one becomes an order."""
        if word == HOME and self._homes:
            return True
        self.orders.put((word, ref))
        return False

    def _order_stop(self) -> None:
        self.orders.put((self._stop_word, None))
        self._stop_word = HALT if self._homes else LATCH


class PlayedTcpArm(PlayedMover, ABC):
    """An arm at ports, which sends frames again and again until it is hushed."""

    def __init__(self, ports: int, joined: Callable[[int], None] = lambda port: None) -> None:
        super().__init__()
        self._lock = threading.RLock()
        self._quiet, self._ending = threading.Event(), threading.Event()
        self.ports = Ports(ports, self._told, joined)
        self._thread = threading.Thread(target=self._speak, name="played frames", daemon=True)
        self._thread.start()

    @abstractmethod
    def _told(self, port: int, data: bytes) -> None:
        """Take what was sent to a port."""

    @abstractmethod
    def _frame(self) -> None:
        """Send a frame."""

    @abstractmethod
    def _forget(self) -> None:
        """Forget what was under way, as all clients are gone."""

    def hush(self) -> None:
        self._quiet.set()

    def vanish(self) -> None:
        self._quiet.set()
        self.ports.close()
        self._forget()

    def come_back(self) -> None:
        self._homes = False  # whatever it is told to do from now on is an order
        self._stop_word = HALT  # of what was left at work; a second one is the plant's latch
        self.rests()
        self.ports.open()
        self._quiet.clear()

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self.ports.close()

    def _speak(self) -> None:
        while not self._ending.wait(FRAME_S):
            if not self._quiet.is_set():
                self._frame()
