"""What devices of a kind can be told, as a kind in Python writes it down."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from arboleda.model.commands import OnStop
from arboleda.model.errors import ArboledaError
from arboleda.model.facts import Value

from .declared import Computed, Effect, FactType

Sets = Mapping[str, Value] | Callable[..., Mapping[str, Value]]
"""The facts that a verb makes so, `"$mm"` for its parameter mm; or a function of its parameters."""
Seconds = float | Callable[..., float]


class KindError(ArboledaError):
    """A kind that cannot be, or settings that it does not take; the sentence says why."""


@dataclass(frozen=True)
class Number:
    """A number within two limits; a whole one where both are: `Number(1, 40)`, `Number(0.5, 2.0)`."""

    lower: float
    upper: float

    def __post_init__(self) -> None:
        if not -math.inf < self.lower < self.upper < math.inf:
            raise KindError(f"a Number has two limits, the lower one first: Number(1, 40); not {self}")

    @property
    def type(self) -> FactType:
        whole = isinstance(self.lower, int) and isinstance(self.upper, int)
        of: type[Value] = int if whole else float
        return FactType(type=of, first=of(self.lower), lower=self.lower, upper=self.upper)


@dataclass(frozen=True, kw_only=True)
class Verb:
    """One thing that devices of a kind can be told; `motion`, `process`, `switch` and `query` make one."""

    effect: Effect
    parameters: Mapping[str, object] = field(default_factory=dict)
    sets: Sets = field(default_factory=dict)
    needs: Mapping[str, Value] = field(default_factory=dict)
    takes_s: Seconds = 0.0
    at_most_s: float | None = None
    on_stop: OnStop = OnStop.HALT
    holds_part: bool = False
    answers: Sequence[Value] = ()
    virtual: Computed | None = None


def motion(
    *,
    parameters: Mapping[str, object] | None = None,
    sets: Sets | None = None,
    needs: Mapping[str, Value] | None = None,
    takes_s: Seconds = 0.0,
    at_most_s: float | None = None,
    virtual: Computed | None = None,
) -> Verb:
    """It moves something of the device, and is halted by a stop."""
    return Verb(
        effect=Effect.MOTION,
        parameters=parameters or {},
        sets=sets or {},
        needs=needs or {},
        takes_s=takes_s,
        at_most_s=at_most_s,
        virtual=virtual,
    )


def process(
    *,
    parameters: Mapping[str, object] | None = None,
    sets: Sets | None = None,
    needs: Mapping[str, Value] | None = None,
    takes_s: Seconds = 0.0,
    at_most_s: float | None = None,
    finishes: bool = False,
    virtual: Computed | None = None,
) -> Verb:
    """The device works by itself; one that `finishes` goes on through a stop."""
    return Verb(
        effect=Effect.PROCESS,
        parameters=parameters or {},
        sets=sets or {},
        needs=needs or {},
        takes_s=takes_s,
        at_most_s=at_most_s,
        on_stop=OnStop.FINISH if finishes else OnStop.HALT,
        virtual=virtual,
    )


def switch(
    *,
    sets: Sets,
    parameters: Mapping[str, object] | None = None,
    needs: Mapping[str, Value] | None = None,
    takes_s: Seconds = 0.0,
    at_most_s: float | None = None,
    holds_part: bool = False,
    virtual: Computed | None = None,
) -> Verb:
    """It sets something that stays as it is set; one that `holds_part` sets a bool: whether it holds one."""
    return Verb(
        effect=Effect.SWITCH,
        parameters=parameters or {},
        sets=sets,
        needs=needs or {},
        takes_s=takes_s,
        at_most_s=at_most_s,
        holds_part=holds_part,
        virtual=virtual,
    )


def query(
    *,
    answers: Sequence[Value],
    parameters: Mapping[str, object] | None = None,
    needs: Mapping[str, Value] | None = None,
    takes_s: Seconds = 0.0,
    at_most_s: float | None = None,
    virtual: Computed | None = None,
) -> Verb:
    """It asks the device for one of some answers; a virtual one gives the first, or what `virtual` says."""
    return Verb(
        effect=Effect.QUERY,
        parameters=parameters or {},
        needs=needs or {},
        takes_s=takes_s,
        at_most_s=at_most_s,
        answers=answers,
        virtual=virtual,
    )
