"""Shared zones as plain data for screens."""

from __future__ import annotations

from typing import Any

from arboleda.engine import Zones


def zone_rows(zones: Zones) -> list[dict[str, Any]]:
    """A row for each zone, in the order of the plant file."""
    return [_row(zones, zone) for zone in zones.names]


def _row(zones: Zones, zone: str) -> dict[str, Any]:
    holder = zones.holder(zone)
    state = "free" if holder is None else "quarantined" if zones.is_quarantined(zone) else "held"
    waiting = [robot for robot, asked in zones.queue.waiting if zone in asked]
    return {"zone": zone, "state": state, "robot": holder, "waiting": waiting}
