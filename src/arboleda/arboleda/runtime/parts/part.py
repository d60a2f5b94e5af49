"""What every part is, and what parts know of each other."""

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
    """Where the MQTT clients of this process go; read once the broker part is started."""

    address: Address
    credentials: Credentials | None


def not_sent(message: object, error: Exception) -> None:
    """A message that lost its connection just now; the lost connection itself is told by its client."""
    LOG.debug("%s was not sent: %s", message, error)
