"""Lines that a controller answers in their order, and what waits for each answer."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Generic, TypeVar

from .link import LinkBroken

REPLY_S = 2.0  # a controller answers in milliseconds

R = TypeVar("R")


@dataclass(frozen=True, kw_only=True)
class Due(Generic[R]):
    """Reply that a line still waits for; `take` takes it, with the time."""

    name: str
    at: float
    take: Callable[[float, R], None]


class RepliesDue(Generic[R]):
    """Queue of the lines that a controller has not answered yet."""

    def __init__(self) -> None:
        self._dues: deque[Due[R]] = deque()

    @property
    def deadline(self) -> float:
        """The time (s) at which the first one is overdue."""
        return self._dues[0].at + REPLY_S if self._dues else math.inf

    @property
    def is_empty(self) -> bool:
        """True where no answer is owed. What is asked again and again waits for that: else the answer to the
        next question would count for one whose own was lost, and so on without an end.
        """
        return not self._dues

    @property
    def names(self) -> Iterator[str]:
        return (each.name for each in self._dues)

    def add(self, now: float, name: str, take: Callable[[float, R], None]) -> None:
        self._dues.append(Due(name=name, at=now, take=take))

    def pop(self) -> Due[R] | None:
        """The line that the next reply answers, which is not waited for any more; None if none was said."""
        return self._dues.popleft() if self._dues else None

    def check(self, now: float) -> None:
        """Raises LinkBroken where a line is not answered in time."""
        if now >= self.deadline:
            raise LinkBroken(f"it has not answered {self._dues[0].name} for {REPLY_S:g} s")
