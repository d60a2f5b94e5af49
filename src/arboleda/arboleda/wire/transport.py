"""Events and orders of an MQTT client: publications out, deliveries and its own connection in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple


class Publication(NamedTuple):
    """Message to publish. It is a tuple, as `Delivery` is: each telemetry makes both, and tuples are fast."""

    topic: str
    payload: bytes
    qos: int = 1
    retain: bool = False


class Delivery(NamedTuple):
    """Message that a subscription received; `retain` as the broker flagged it."""

    at: float
    topic: str
    payload: bytes
    retain: bool = False


@dataclass(frozen=True, kw_only=True)
class Connection:
    """Event: a client reached or lost its broker; `client` is its MQTT client id."""

    at: float
    client: str
    up: bool
