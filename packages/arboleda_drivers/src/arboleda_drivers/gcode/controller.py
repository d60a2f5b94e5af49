"""Controller of a machine of axes: what the dialects of G-code have in common.

What a firmware says and hears is its dialect's: `grbl.py`, `marlin.py`, `moonraker.py`.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from enum import Enum
from typing import Any, Generic, TypeVar

from arboleda.drivers import Jointed, Robot
from arboleda_drivers.connections.controller import Controller
from arboleda_drivers.connections.receipts import Receipts

from .settings import Settings

ANSWER_S = 3.0  # to a line, while nothing else is under way
HOMING_S = 120.0

How = TypeVar("How", bound=Enum)


class GcodeController(Controller):
    """Controller of one machine of axes, which is asked for its state."""

    stops: Halting[Any]

    def __init__(self, devices: Sequence[Robot], settings: Settings) -> None:
        """Raises ValueError unless the device is one robot of axes, each with its letter."""
        if len(devices) != 1 or not isinstance(devices[0], Jointed):
            raise ValueError("a machine with G-code is one robot of axes")
        for _, problem in settings.problems(devices[0]):
            raise ValueError(problem)
        super().__init__(devices[0], peer=settings.peer, kind="G-code")
        self.settings = settings
        self.boot = 1

    def forget(self, now: float) -> None:
        self.heard_at, self.query_at = now, now
        self.is_heard = False  # has told a position on this line

    @property
    def next_deadline(self) -> float:
        return self.query_at

    @property
    def is_known(self) -> bool:
        return self.is_heard

    @property
    def takes_commands(self) -> bool:
        return self.is_heard

    def stop(self, now: float, id: str) -> None:
        self.stops.id = id
        self.halt(now)

    @abstractmethod
    def halt(self, now: float) -> None:
        """Bring the machine to a stop, and have nothing go on after that."""


class Halting(Generic[How]):
    """Stop that is under way `since` a time (s), by `how` it is made; `id` is that of its command."""

    def __init__(self, receipts: Receipts, now: float) -> None:
        self.how: How | None = None
        self.since = now
        self.id = ""
        self._receipts = receipts

    def begin(self, now: float, how: How) -> None:
        self.how, self.since = how, now

    def end(self) -> None:
        """Tell that the stop has come to its end."""
        self.how = None
        self._receipts.tell(accepted=self.id)
        self.id = ""
