"""Acts of a person in the playground, each at its tick: with the seed, all that a run is made of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

from arboleda.model.messages import Verb
from arboleda.model.verbs import Arguments


@dataclass(frozen=True, kw_only=True)
class TaskAsked:
    """Somebody asks for a task at a tick."""

    tick: int
    text: str


@dataclass(frozen=True, kw_only=True)
class VerbAsked:
    """An operator's verb at a tick; what it declares as done by hand is done by hand just before."""

    tick: int
    verb: Verb
    scope: str
    by_hand: bool = False
    arguments: Arguments = ()


@dataclass(frozen=True, kw_only=True)
class HandLent:
    """Somebody does at a tick, at the machine itself, what an advice says: `do` is a `Hand` by its value."""

    tick: int
    do: str
    scope: str


@dataclass(frozen=True, kw_only=True)
class MishapBegun:
    """A mishap begins at a tick; `target` is whom, as the simulator names them."""

    tick: int
    name: str
    target: str
    seconds: float


Act: TypeAlias = TaskAsked | VerbAsked | HandLent | MishapBegun
KINDS: dict[str, type[Act]] = {kind.__name__: kind for kind in (TaskAsked, VerbAsked, HandLent, MishapBegun)}


def plain(act: Act) -> dict[str, Any]:
    """An act as plain data."""
    return {"kind": type(act).__name__, **vars(act)}


def act_of(row: dict[str, Any]) -> Act:
    """The act of such data, also of what JSON made of it."""
    fields = {name: value for name, value in row.items() if name != "kind"}
    if row["kind"] == VerbAsked.__name__:
        arguments = tuple((name, value) for name, value in row["arguments"])
        fields |= {"verb": Verb(row["verb"]), "arguments": arguments}
    return KINDS[row["kind"]](**fields)
