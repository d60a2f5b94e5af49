"""Faults by hand at virtual devices as the web server sees them: what can be provoked, begun and ended."""

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
