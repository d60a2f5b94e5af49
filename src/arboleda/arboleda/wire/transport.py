"""Events and orders of an MQTT client: publications out, deliveries and its own connection in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple


class Publication(NamedTuple):
    """Message to publish. It is a tuple, as `Delivery` is: each telemetry makes both, and tuples are fast.

    Over MQTT 5 the answer is wanted on the topic `reply`, with `about` as its correlation data.
    """

    topic: str
    payload: bytes
    qos: int = 1
    retain: bool = False
    reply: str = ""
    about: bytes = b""


class Delivery(NamedTuple):
    """Message that a subscription received; `retain` as the broker flagged it, `about` its correlation
    data."""

    at: float
    topic: str
    payload: bytes
    retain: bool = False
    about: bytes = b""


@dataclass(frozen=True, kw_only=True)
class Connection:
    """Event: a client reached or lost its broker; `client` is its MQTT client id."""

    at: float
    client: str
    up: bool
