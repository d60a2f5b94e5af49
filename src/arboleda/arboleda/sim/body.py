"""What a board drives: the axes of an arm, or a mobile robot on its grid."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from arboleda.wire.topics import Channel


class Told(NamedTuple):
    """What a body can say of itself: the angles of an arm or the node of a mobile, and what it holds."""

    q: tuple[float, ...] | None = None
    node: int | None = None
    effector: bool | None = None
    piece: bool | None = None


class Body(Protocol):
    """Every time is in microseconds and never earlier than the one before.

    `next_change_us`: when it arrives somewhere if nobody interferes; None while still.
    """

    axes: int | None
    channels: frozenset[Channel]
    next_change_us: int | None

    @property
    def moving(self) -> bool: ...

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

    def put_at_reference(self) -> None:
        """Somebody moves the still robot by hand to its reference, and has it count from there."""

    def reset(self) -> None:
        """Everything as a board without memory comes up; what is moved stays where it is."""

    def tell(self) -> Told:
        """Where it is and what it holds."""
