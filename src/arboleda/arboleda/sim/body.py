"""What a board drives: the axes of an arm, a mobile robot on its grid, or a machine of a declared kind."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from arboleda.model.commands import Command, Position
from arboleda.model.facts import Facts, Value
from arboleda.wire.payloads import Goal, OrderGoal
from arboleda.wire.topics import Channel


class BodyReport(NamedTuple):
    """What a body can say of itself: the angles of an arm, the node of a mobile or the facts of a machine,
    and what it holds."""

    q: tuple[float, ...] | None = None
    node: int | None = None
    effector: bool | None = None
    piece: bool | None = None
    facts: Facts | None = None


class End(NamedTuple):
    """A command that a machine ended by itself: answered, or given up with a word for why."""

    goal: Goal
    answer: Value | None = None
    failure: str | None = None


class Robotic:
    """A body that takes no orders: it halts when it is stopped, and is done when it arrives."""

    def set_by_hand(self, facts: Facts) -> None:
        """It has no facts."""

    def take_out(self) -> None:
        """It holds nothing."""

    homes = True
    ends: Sequence[End] = ()
    finishes = False

    def objection(self, goal: OrderGoal, *, latched: bool, faulted: bool) -> str | None:
        return "formato"

    def command(self, goal: OrderGoal) -> Command | None:
        return None

    def is_work(self, goal: OrderGoal) -> bool:
        return False

    def take_ends(self) -> list[End]:
        return []


class Body(Protocol):
    """Every time is in microseconds and never earlier than the one before.

    `next_change_us`: when it arrives somewhere if nobody interferes; None while still. `homes`: whether it
    has a reference. `ends` are those that its board has not taken yet.
    """

    axes: int | None
    channels: frozenset[Channel]
    next_change_us: int | None
    homes: bool

    @property
    def true_place(self) -> Position | None:
        """Where it is, whatever it takes itself to be, in SI units; None where it has no place."""

    @property
    def true_facts(self) -> Mapping[str, Value]:
        """What is so of it, whatever its board says."""

    @property
    def ends(self) -> Sequence[End]: ...

    @property
    def moving(self) -> bool: ...

    @property
    def finishes(self) -> bool:
        """Whether what it does now goes on through a stop and a silence."""

    def objection(self, goal: OrderGoal, *, latched: bool, faulted: bool) -> str | None:
        """The word that refuses an order now; None where it can be carried out."""

    def command(self, goal: OrderGoal) -> Command | None:
        """What an order asks for; None where it knows no such verb or value."""

    def is_work(self, goal: OrderGoal) -> bool:
        """Whether an order that can be carried out keeps the machine busy."""

    def take_ends(self) -> list[End]:
        """What ended since the last call, in order."""

    def admits(self, goal: Any) -> bool:
        """Whether a goal, of the type that `decode` makes for this body, is within its limits."""

    def start(self, now_us: int, goal: Any) -> None:
        """Head for an admitted goal; even no way at all takes a moment."""

    def home(self, now_us: int) -> None:
        """Head for the reference position."""

    def stop(self, now_us: int) -> None:
        """Come to rest as soon as the ramp, or the next node, allows."""

    def advance(self, now_us: int) -> None:
        """Move on to where it is at this time."""

    def switch_effector(self, on: bool) -> None: ...

    def place(self, told: BodyReport, *, holds: bool) -> None:
        """Be, still, as somebody else's body has told of itself; what it has not told stays as it is."""

    def set_by_hand(self, facts: Facts) -> None:
        """Somebody makes facts so at the machine, which does nothing meanwhile."""

    def take_out(self) -> None:
        """Somebody takes out the part that the machine holds, which does nothing meanwhile."""

    def put_at_reference(self) -> None:
        """Somebody moves the still robot by hand to its reference, and has it count from there."""

    def reset(self) -> None:
        """Everything as a board without memory comes up; what is moved stays where it is."""

    def tell(self) -> BodyReport:
        """Where it is and what it holds."""
