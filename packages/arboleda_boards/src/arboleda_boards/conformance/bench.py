"""Bench of a board: keeps its reports, and makes the commands that a check may ask for."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from arboleda.drivers import Evidence, PayloadError
from arboleda.wire.topics import Channel, parse
from arboleda.wire.transport import Delivery

MOVING, NOT_HOMED, LATCHED = 1, 3, 4  # codes of `estado`


@dataclass(frozen=True, kw_only=True)
class Send:
    """Publish this to the board."""

    channel: Channel
    payload: bytes
    retain: bool = False


@dataclass(frozen=True, kw_only=True)
class Jostle:
    """Have the board lose its connection for a moment, by taking its client id."""


@dataclass(frozen=True, kw_only=True)
class Wait:
    """Let time pass until something is so; the check gets whether it was."""

    seconds: float
    until: Callable[[], bool] = lambda: False


Steps = Generator[Send | Jostle | Wait, bool, Any]


class CheckFailed(Exception):
    """A check found the board in the wrong; the sentence says how."""


class CheckSkipped(Exception):
    """A check cannot be made on this board; the sentence says why."""


@dataclass(frozen=True, kw_only=True)
class BoardTelemetry:
    """One telemetry message; None for missing fields."""

    at: float
    state: int
    number: int | None
    epoch: int | None
    least_epoch: int | None
    ack: int | None
    done: int | None
    refusal: str | None
    refused: int | None
    boot_id: int | None
    ack_token: str | None
    done_token: str | None

    @property
    def place(self) -> tuple[Any, ...] | None:
        """The position or the facts of this report: equal in two reports if nothing moved between them."""
        raise NotImplementedError


ReportT = TypeVar("ReportT", bound=BoardTelemetry)


class Bench(ABC, Generic[ReportT]):
    """A board on trial, `name` on MQTT; `seq` is the last number used in `epoch`."""

    patience_s = 30.0  # for it to come to rest

    def __init__(self, name: str, epoch: int) -> None:
        self.name = name
        self.epoch = epoch
        self.seq = 0
        self.now = 0.0
        self.beating = False
        self.reports: list[ReportT] = []
        self.damaged: list[str] = []
        self.arrivals = 0  # how often its presence came

    @property
    def last(self) -> ReportT:
        return self.reports[-1]

    def moves_since(self, count: int) -> bool:
        """True if a report after the first `count` says that the board moves."""
        return any(each.state == MOVING for each in self.reports[count:])

    @property
    def spoken(self) -> Evidence:
        """The level that its reports belong to."""
        if not self.reports or not self.says_where:
            return Evidence.STATE
        return Evidence.JOINTS if self.last.boot_id is None else Evidence.IDS

    @property
    @abstractmethod
    def says_where(self) -> bool:
        """True if its last report says more than that it moves or not."""

    @property
    @abstractmethod
    def place(self) -> tuple[Any, ...]:
        """The position or the facts of its last report; equal while nothing is done."""

    def hear(self, delivery: Delivery) -> None:
        """A message from the board."""
        self.now = max(self.now, delivery.at)
        channel = parse(delivery.topic)[1]
        if channel is Channel.PRESENCE:
            self.arrivals += delivery.payload == b"1" and not delivery.retain
            return
        try:
            self.reports.append(self._read(delivery))
            epoch = max(self.last.epoch or 0, self.last.least_epoch or 0)
            if not self.seq and epoch >= self.epoch:
                self.epoch = epoch + 1
        except PayloadError as error:
            self.damaged.append(f"{error}: {delivery.payload[:80]!r}")

    def send(
        self, channel: Channel, *, seq: int | None = None, epoch: int | None = None, **body: Any
    ) -> Send:
        """A command with the next number, unless another is given."""
        if seq is None:
            self.seq += 1
        numbers = {"seq": self.seq if seq is None else seq, "epoca": self.epoch if epoch is None else epoch}
        return Send(channel=channel, payload=json.dumps({**body, **numbers}).encode())

    @abstractmethod
    def _read(self, delivery: Delivery) -> ReportT:
        """The report in a payload; PayloadError if it cannot be read."""
