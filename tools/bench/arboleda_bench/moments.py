"""Moments in which the robots of a cell were commanded and came to rest, and figures from these."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from arboleda.drivers import Command, SetEffector


@dataclass(frozen=True, kw_only=True)
class Moment:
    """A robot received a command, or ended its move; `at` in s of the benchmark's clock.

    A drive may end twice: as the robot stops, and as it reports what proves that.
    `last`: the move was the last one of a task, so a pause that the recipe declares follows.
    """

    at: float
    command: Command
    ended: bool
    last: bool = False


@dataclass(frozen=True, kw_only=True)
class Reaction:
    """From the end of a move to the receipt of the next command of its cell, s."""

    seconds: float
    before: Command
    after: Command


@dataclass(frozen=True, kw_only=True)
class Cycle:
    """One task as its robots saw it: its last end, and the time that its moves took together, s."""

    ended_at: float
    moves_s: float


def reactions(moments: Iterable[Moment]) -> list[Reaction]:
    """Every end of a move that a command follows without a declared pause between them."""
    return [
        Reaction(seconds=after.at - before.at, before=before.command, after=after.command)
        for before, after in pairwise(moments)
        if before.ended and not before.last and not after.ended
    ]


def milliseconds(side: Iterable[Reaction]) -> list[float]:
    """The duration of each reaction, ms."""
    return [1000 * each.seconds for each in side]


def cycles(moments: Sequence[Moment]) -> list[Cycle]:
    """The tasks that have ended."""
    found, moves_s = [], 0.0
    for before, after in pairwise(moments):
        if not after.ended:
            continue
        moves_s += after.at - before.at
        if after.last:
            found.append(Cycle(ended_at=after.at, moves_s=moves_s))
            moves_s = 0.0
    return found


def kind(reaction: Reaction) -> str:
    """The kinds of robots before and after: `mobile to arm`."""
    return f"{_who(reaction.before)} to {_who(reaction.after)}"


def _who(command: Command) -> str:
    return "effector" if isinstance(command, SetEffector) else WHO[type(command).__name__]


WHO = {"FollowPath": "mobile", "MoveJoints": "arm"}
