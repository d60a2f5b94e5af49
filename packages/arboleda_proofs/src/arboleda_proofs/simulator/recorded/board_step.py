"""One step of a bridge, as far as it is about one board: what it took in, and what it gave out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from arboleda.drivers import Command, Report
from arboleda.wire.rejections import ForeignCommand, Rejection
from arboleda.wire.transport import Delivery, Publication


class BoardStep:
    """A step at `now`; `late`: the bridge was away before. `was_up`: the board was there, as the bridge said.

    `plants` are those that it heard, the last one now; `is_beaten`: one of them beat in this step. `orders`
    are commands with an id, each with the plant that was heard by then, `strangers` those without, and when
    they came. `is_up`, `is_lost`: the bridge says that the board is there after it, or was lost in it.
    `is_stirred`: the broker or the board came or went, `is_shut`: one of them went. `told` are reports with
    the telemetry that each of them repeats, `states` those of whose telemetry nothing is known.
    """

    def __init__(self) -> None:
        self.now = 0.0
        self.was_up = self.is_up = self.late = False
        self.is_lost = self.is_beaten = self.is_stirred = self.is_shut = False
        self.plants: list[int | None] = [None]
        self.heard: list[Delivery] = []
        self.orders: list[tuple[Command, int | None]] = []
        self.strangers: list[tuple[float, Command]] = []
        self.reports: list[Report] = []
        self.states: list[Report] = []
        self.notices: list[Rejection | ForeignCommand] = []
        self.published: list[Publication] = []
        self.told: list[tuple[Report, Mapping[str, Any]]] = []
        self.lists: tuple[list[Any], ...] = (
            self.heard,
            self.orders,
            self.strangers,
            self.reports,
            self.states,
            self.notices,
            self.published,
            self.told,
        )

    def command(self, at: float, command: Command, plant: int | None) -> None:
        if command.id:
            self.orders.append((command, plant))
        else:
            self.strangers.append((at, command))

    def stir(self, *, gone: bool) -> None:
        self.is_stirred = True
        self.is_shut |= gone

    @property
    def is_surely_up(self) -> bool:
        """True if the board was there all through the step."""
        return self.was_up and not self.is_stirred and not self.is_lost
