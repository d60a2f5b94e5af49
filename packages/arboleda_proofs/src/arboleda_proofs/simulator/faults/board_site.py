"""Boards and their connections, as the faults see them that need nothing else of a world."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Protocol

from arboleda.drivers import Facts
from arboleda.model.plant_model import PlantModel
from arboleda.rig.network import Client
from arboleda.sim.board import Board


class Connections(Protocol):
    """Connections to a broker, by the names of those that have them."""

    @property
    def clients(self) -> Mapping[str, Client]: ...


class Hands(Protocol):
    """Hands of somebody at the machines themselves."""

    def open_effector(self, board: str) -> None:
        """Open an effector as if by somebody else; its board says that it is off."""

    def set_facts(self, board: str, facts: Facts) -> None:
        """Make facts so at a device."""


class BoardSite(Protocol):
    """Virtual boards that something can go wrong with: a simulated world, or those of a real start.

    Boards go by their MQTT names; `holds` counts the faults that keep something up at one.
    """

    @property
    def now(self) -> float: ...

    @property
    def awake_s(self) -> float: ...

    @property
    def model(self) -> PlantModel: ...

    @property
    def boards(self) -> Mapping[str, Board]: ...

    @property
    def broker(self) -> Connections: ...

    @property
    def manual(self) -> Hands: ...

    @property
    def holds(self) -> Counter[tuple[str, str]]: ...

    def is_on(self, process: str) -> bool:
        """True if a board has power."""

    def power_off(self, board: str, *, will_after_s: float = 0.0) -> None:
        """Cut a board's power; the broker tells its last will when it notices."""

    def power_on(self, board: str) -> None:
        """Power a board: it boots and reaches the broker."""

    def stall(self, process: str, seconds: float) -> None:
        """Have a board do nothing for a while; what reaches it waits."""

    def go_on(self, process: str) -> None:
        """Have a stalled board go on."""

    def wake(self, process: str) -> None:
        """Have a board step at once, as something was done to it."""
