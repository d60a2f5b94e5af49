"""Bytes that come from a port of the controller, and those that go there."""

from __future__ import annotations

from dataclasses import dataclass

DASHBOARD, RTDE, PRIMARY = "dashboard", "rtde", "primary"  # ports


@dataclass(frozen=True, kw_only=True)
class Received:
    """Event: bytes from the port of this name."""

    port: str
    data: bytes


@dataclass(frozen=True, kw_only=True)
class Send:
    """Message: send bytes to the port of this name."""

    port: str
    data: bytes
