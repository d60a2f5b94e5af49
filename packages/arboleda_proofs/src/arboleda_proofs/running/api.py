"""Faults by hand, reports of failures and the demonstration of a plant that runs, for the web server."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from arboleda.extension import Refused, Sentence


class FaultRefused(Refused):
    """Nothing is provoked; the sentence says why, and what can be."""


@dataclass(frozen=True, kw_only=True)
class FaultOffer:
    """Fault that can be provoked at a robot; one that does not last is an instant."""

    robot: str
    kind: str
    about: Sentence
    lasts: bool


@dataclass(frozen=True, kw_only=True)
class BegunFault:
    """Fault that was provoked and goes on for `left_s` more; 0.0 for one that was an instant."""

    number: int
    robot: str
    kind: str
    about: Sentence
    left_s: float


class FaultsApi(Protocol):
    """Faults of one start of a plant; none survives it. Each call but `offers` may wait for a moment."""

    @abstractmethod
    def offers(self) -> Sequence[FaultOffer]:
        """The faults that can be provoked, by robot in the file's order; none without virtual devices."""

    @abstractmethod
    def begun(self) -> Sequence[BegunFault]:
        """The faults that go on now, the first one first."""

    @abstractmethod
    def begin(self, kind: str, robot: str, seconds: float | None) -> BegunFault:
        """Have a fault begin, for so many seconds (None: as is usual); FaultRefused where it cannot."""

    @abstractmethod
    def end(self, robot: str = "", number: int | None = None) -> Sequence[BegunFault]:
        """End the faults of a robot ("": of all), or the one of this number; those that went on."""


class ReportsApi(Protocol):
    """Reports of one plant."""

    @abstractmethod
    def report(self, task: str) -> str | None:
        """The report on a failed task, as one HTML file; None: it is being written now, ask again. It waits
        for the disk; an ArboledaError says why there is none."""


class DemonstrationApi(Protocol):
    """Demonstration: it gives tasks until somebody ends it."""

    @abstractmethod
    def end(self) -> None:
        """Give no more tasks and have nothing fail any more; from any thread."""
