"""Result of a benchmark: figures of ours, of the floor, and the aim."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Aim:
    """A bound on the ratio to the floor; with `of_ratio` False on the figure itself."""

    most: float | None = None
    least: float | None = None
    of_ratio: bool = True

    def __str__(self) -> str:
        sign, bound = ("<=", self.most) if self.most is not None else (">=", self.least)
        return f"{sign} {bound:g}{'x' if self.of_ratio else ''}"


@dataclass(frozen=True, kw_only=True)
class Figure:
    """One line of the table; `ours` and `floor` in `unit`. `floor` is None where nothing compares."""

    name: str
    unit: str
    ours: float
    floor: float | None = None
    aim: Aim | None = None

    @property
    def ratio(self) -> float | None:
        """The ratio of ours to the floor; None if there is no floor, or it is 0."""
        return self.ours / self.floor if self.floor else None

    @property
    def reached(self) -> bool | None:
        """True if the aim is reached; None if there is none, or nothing to compare with."""
        if self.aim is None:
            return None
        value = self.ratio if self.aim.of_ratio else self.ours
        if value is None:
            return None
        most, least = self.aim.most, self.aim.least
        return (most is None or value <= most) and (least is None or value >= least)


@dataclass(frozen=True, kw_only=True)
class Result:
    """Figures of one benchmark; `notes` say in words what was run and what the figures do not show."""

    figures: Sequence[Figure]
    notes: Sequence[str] = ()


def percentile(values: Sequence[float], percent: int) -> float:
    """The least of the `values` that at least `percent` of them do not exceed (nearest rank)."""
    ordered = sorted(values)
    return ordered[max(0, -(-len(ordered) * percent // 100) - 1)]
