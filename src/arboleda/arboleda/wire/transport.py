"""Events and orders of an MQTT client: publications out, deliveries and its own connection in."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Publication:
    """Message to publish."""

    topic: str
    payload: bytes
    qos: int = 1
    retain: bool = False


@dataclass(frozen=True, kw_only=True)
class Delivery:
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
