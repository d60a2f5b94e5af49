"""Queue for shared zones: the robots that wait, and for which zones, the first first."""

from __future__ import annotations


class ZoneQueue:
    """Requests of the robots that wait, in the order of asking; each for all of its zones at once."""

    def __init__(self) -> None:
        self._asked: dict[str, frozenset[str]] = {}

    @property
    def waiting(self) -> tuple[tuple[str, frozenset[str]], ...]:
        """Each waiting robot with the zones that it asked for, the first robot first."""
        return tuple(self._asked.items())

    def asked_by(self, robot: str) -> frozenset[str] | None:
        """The zones for which a robot waits; None where it does not wait."""
        return self._asked.get(robot)

    def join(self, robot: str, zones: frozenset[str]) -> None:
        """Have a robot wait as the last; a robot that waits already keeps its place."""
        self._asked.setdefault(robot, zones)

    def go_first(self, robot: str) -> None:
        """Put a robot that waits before all others."""
        self._asked = {robot: self._asked[robot], **self._asked}

    def leave(self, robot: str) -> None:
        """Have a robot wait no longer."""
        self._asked.pop(robot, None)

    def ahead_of(self, robot: str) -> tuple[str, ...]:
        """The robots that wait before a waiting robot for one of its zones, the first first."""
        names, zones = list(self._asked), self._asked[robot]
        return tuple(name for name in names[: names.index(robot)] if zones & self._asked[name])

    def asked_before(self, robot: str) -> tuple[str, str] | None:
        """A zone that a waiting robot asked for, and the first of those that asked for it before."""
        asked = self._asked.get(robot, frozenset())
        for other in self.ahead_of(robot) if asked else ():
            return min(asked & self._asked[other]), other
        return None
