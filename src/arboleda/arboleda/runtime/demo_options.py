"""Options of the demonstration: tasks that never end, and faults, of a plant on virtual boards."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class DemoOptions:
    """A demonstration is wanted."""
