"""What an MQTT client carries: publications out, deliveries and its own connection in."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Publication:
    """One message to publish."""

    topic: str
    payload: bytes
    qos: int = 1
    retain: bool = False


@dataclass(frozen=True, kw_only=True)
class Delivery:
    """One message that a subscription received; `retain` as the broker flagged it."""

    at: float
    topic: str
    payload: bytes
    retain: bool = False


@dataclass(frozen=True, kw_only=True)
class Connection:
    """A client reached or lost its broker; `client` is its MQTT client id."""

    at: float
    client: str
    up: bool
