"""Levels of faults, by name: the range of faults per minute."""

from __future__ import annotations

CRASHES = "crashes"
LEVELS: dict[str, tuple[float, float]] = {
    "none": (0.0, 0.0),
    "few": (1.0, 4.0),
    "normal": (8.0, 40.0),
    "many": (20.0, 90.0),
    CRASHES: (8.0, 30.0),
}
"""Faults per minute: from where to where a seed draws its own. Only where the plant is to crash it does."""
