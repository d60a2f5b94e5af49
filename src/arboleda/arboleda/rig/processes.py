"""Processes of a world: those that are off or stand still, and when each has to step next."""

from __future__ import annotations

from collections.abc import Iterable


class Processes:
    """Processes by name: plant, bridge and boards.

    `off` are those that do not run, `stalled` has until when others stand still, `due` when each steps next.
    """

    def __init__(self, names: Iterable[str], now: float) -> None:
        self.off: set[str] = set()
        self.stalled: dict[str, float] = {}
        self.due: dict[str, float] = dict.fromkeys(names, now)

    def is_awake(self, process: str) -> bool:
        """True where a process runs and does not stand still."""
        return process not in self.off and process not in self.stalled
