"""Interface of every part, and of those that parts know of each other."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Protocol

from arboleda.adapters.broker_login import Address, Credentials

LOG = logging.getLogger(__name__)
Crash = Callable[[str, BaseException], None]  # told which part broke down, and on what


class Part(Protocol):
    """One piece of a plant; `stop` is idempotent and waits for its end."""

    def start(self) -> None: ...
    def stop(self) -> None: ...


class BrokerAddress(Protocol):
    """The address for the MQTT clients of this process; read once the broker part is started."""

    address: Address
    credentials: Credentials | None


class Broker(BrokerAddress, Protocol):
    """The broker of a plant, its own or another one; `secure` where it speaks TLS."""

    secure: bool


class PageAddress(Protocol):
    """The server of this process: `port` is 0 before it listens."""

    @property
    def port(self) -> int: ...
    def address_of(self, cell: str, task: str | None) -> str | None:
        """The address at which a browser shows a cell, or a task of it; None if there is no page."""


def not_sent(message: object, error: Exception) -> None:
    """Log a message that was lost with its connection; the client itself reports the lost connection."""
    LOG.debug("%s was not sent: %s", message, error)
