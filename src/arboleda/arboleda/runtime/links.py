"""State of a plant's links: each part adds what it knows of one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any


class Links:
    """Links: as `PageApi.links` has them; from any thread."""

    def __init__(self) -> None:
        self._known: list[Callable[[], Mapping[str, Any]]] = []

    def add(self, known: Callable[[], Mapping[str, Any]]) -> None:
        """Add a part of it, which is asked for each time; from any thread."""
        self._known.append(known)

    def __call__(self) -> dict[str, Any]:
        """Broker, ROS 2, refused messages, standbys, the memory's pace, and the like."""
        found: dict[str, Any] = {"broker": None, "ros": None, "refused": {}, "standbys": []}
        found |= {"demo": False, "memory": None, "faults": []}
        for each in self._known:
            found |= each()
        return found
