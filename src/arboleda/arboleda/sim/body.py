"""Body that a board drives: axes of an arm, a mobile robot on its grid, or a machine of a declared kind."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from arboleda.model import refusals
from arboleda.model.commands import Command, Position
from arboleda.model.facts import Facts, Value
from arboleda.wire.payloads import Goal, VerbGoal
from arboleda.wire.topics import Channel


class BodyReport(NamedTuple):
    """State that a body reports: degrees of an arm, node of a mobile or facts of a machine, and its load."""

    q_deg: tuple[float, ...] | None = None
    node: int | None = None
    effector: bool | None = None
    piece: bool | None = None
    facts: Facts | None = None


class SeenState(NamedTuple):
    """State in which a robot was seen last: `q` of an arm in rad and m."""

    q: tuple[float, ...] | None = None
    node: int | None = None
    effector: bool | None = None
    facts: Facts | None = None


class End(NamedTuple):
    """Command that a machine ended by itself: answered, or given up with a word for the reason."""

    goal: Goal
    answer: Value | None = None
    failure: str | None = None


class Robotic:
    """Body without orders: it halts when it is stopped, and is done when it arrives."""

    def set_by_hand(self, facts: Facts) -> None:
        """Does nothing: it has no facts."""

    def take_out(self) -> None:
        """Does nothing: it holds nothing."""

    homes = True
    ends: Sequence[End] = ()
    finishes = False

    def objection(self, goal: VerbGoal, *, latched: bool, faulted: bool) -> str | None:
        return refusals.FORMAT

    def command(self, goal: VerbGoal) -> Command | None:
        return None

    def is_work(self, goal: VerbGoal) -> bool:
        return False

    def take_ends(self) -> list[End]:
        return []


class Body(Protocol):
    """Body behind a board; every time is in microseconds, and never earlier than the one before.

    `next_change_us`: the time of its next arrival if nobody interferes; None at rest. `homes`: it has a
    reference. `ends`: ends of commands that its board has not taken yet.
    """

    axes: int | None
    channels: frozenset[Channel]
    next_change_us: int | None
    homes: bool

    @property
    def true_place(self) -> Position | None:
        """The true place, whatever the body takes it to be, in SI units; None if it has no place."""

    @property
    def true_facts(self) -> Mapping[str, Value]:
        """The true facts, whatever the board reports."""

    @property
    def ends(self) -> Sequence[End]: ...

    @property
    def moving(self) -> bool: ...

    @property
    def finishes(self) -> bool:
        """True if the present work goes on through a stop and through a silence of the plant."""

    def objection(self, goal: VerbGoal, *, latched: bool, faulted: bool) -> str | None:
        """The word that refuses an order now; None if it can be carried out."""

    def command(self, goal: VerbGoal) -> Command | None:
        """The command that an order means; None if the body knows no such verb or value."""

    def is_work(self, goal: VerbGoal) -> bool:
        """True if an order that can be carried out keeps the machine busy."""

    def take_ends(self) -> list[End]:
        """The ends of work since the last call, in order."""

    def admits(self, goal: Any) -> bool:
        """True if a goal, of the type that `decode` makes for this body, is within its limits."""

    def start(self, now_us: int, goal: Any) -> None:
        """Head for an admitted goal; a move of no length takes a moment, too."""

    def home(self, now_us: int) -> None:
        """Head for the reference position."""

    def stop(self, now_us: int) -> None:
        """Come to rest as soon as the ramp, or the next node, allows."""

    def advance(self, now_us: int) -> None:
        """Move on to where it is at this time."""

    def switch_effector(self, on: bool) -> None: ...

    def place(self, seen: SeenState, *, holds: bool) -> None:
        """Take, at rest, the state in which another body was seen; unseen parts stay as they are."""

    def set_by_hand(self, facts: Facts) -> None:
        """Set facts by hand at the idle machine."""

    def take_out(self) -> None:
        """Take out by hand the part that the idle machine holds."""

    def put_at_reference(self) -> None:
        """Move the resting robot by hand to its reference, from where it counts then."""

    def reset(self) -> None:
        """Reset as a board without memory comes up; moved parts stay where they are."""

    def tell(self) -> BodyReport:
        """The place and load that the body reports."""
