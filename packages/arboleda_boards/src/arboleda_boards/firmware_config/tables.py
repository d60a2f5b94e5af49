"""Tables of the header: the wiring, resolved to places in lists; values as the firmware's core has them."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.drivers import DeviceVerb, FactType

from .shapes import Wiring


@dataclass(frozen=True, kw_only=True)
class TableValue:
    """A value: fixed, or that of a parameter, looked up in `map` unless that is empty."""

    constant: float = 0.0
    parameter: int = -1
    map: tuple[float, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Row:
    """A value, and the states of inputs that stand for it."""

    value: float
    when: tuple[tuple[int, bool], ...]


@dataclass(frozen=True, kw_only=True)
class Reading:
    """The values that inputs stand for; `otherwise` if no row fits."""

    rows: tuple[Row, ...] = ()
    otherwise: float | None = None


@dataclass(frozen=True, kw_only=True)
class Fact:
    name: str
    type: FactType
    source: str  # kTold, kInputs, kAnalog
    reading: Reading = Reading()
    analog: int = 0


@dataclass(frozen=True, kw_only=True)
class Action:
    drive: str  # kOutput, kServo
    index: int
    value: TableValue


@dataclass(frozen=True, kw_only=True)
class Verb:
    declared: DeviceVerb
    sets: tuple[tuple[int, TableValue], ...]
    needs: tuple[tuple[int, float], ...]
    start: tuple[Action, ...]
    end: tuple[Action, ...]
    answer: Reading
    at_least_s: float
    held_fact: int


@dataclass(frozen=True, kw_only=True)
class Tables:
    """A device as the firmware knows it; `unseen`: facts that verbs set and no input looks at."""

    name: str
    wiring: Wiring
    facts: tuple[Fact, ...]
    verbs: tuple[Verb, ...]
    unseen: tuple[str, ...]
