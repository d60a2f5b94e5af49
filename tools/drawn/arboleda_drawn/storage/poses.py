"""Poses of one arm, in the units of the file: far apart, close together, equal, with and without a height."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from arboleda_proofs.simulator.chance import Dice

Section = dict[str, Any]
Values = tuple[float, ...]  # deg and mm, one per joint
MOST_STATIONS = 5  # of those that are drawn one by one


@dataclass(frozen=True, kw_only=True)
class Axis:
    """A joint in deg, or in mm if it `slides`: its limits, and how far from its goal it may stop.

    If it slides, `up` is the direction that lifts: -1 towards `lower`, 1 towards `upper`, 0 neither.
    """

    slides: bool
    lower: float
    upper: float
    tolerance: float
    up: int

    def room(self, value: float) -> float:
        """The distance that it may lift from this value."""
        return (value - self.lower if self.up < 0 else self.upper - value) if self.up else 0.0


class Poses:
    """Draws the poses of one cell, each with regard to those before it."""

    def __init__(self, dice: Dice, axes: Sequence[Axis]) -> None:
        self._dice = dice
        self._axes = axes
        self._drawn: list[Values] = []

    def draw(self, *, approach: bool) -> Section:
        """One pose; with `approach` it may have a point over it."""
        values = self._values()
        self._drawn.append(values)
        return self._section(values, approach=approach)

    def stations(self) -> tuple[Section, int]:
        """The stations of a cell one by one, or by rule, and their number."""
        if self._dice.chance(0.3) and may_have_rack(self._axes):
            return draw_rack(self._dice, self._axes)
        count = 1 + self._dice.below(MOST_STATIONS)
        return {str(number): self.draw(approach=True) for number in range(count)}, count

    def _values(self) -> Values:
        kind = self._dice.random()
        if kind < 0.08:
            return (0.0,) * len(self._axes)  # where homing ends
        if self._drawn and kind < 0.18:
            return self._dice.pick(self._drawn)
        if self._drawn and kind < 0.4:
            return self._near(self._dice.pick(self._drawn))
        return tuple(_inside(axis, self._dice.between(axis.lower, axis.upper)) for axis in self._axes)

    def _near(self, other: Values) -> Values:
        """A pose within about its tolerance of another one, or a little further away."""
        share = self._dice.pick((0.5, 1.0, 1.5, 2.5))
        rows = zip(self._axes, other, strict=True)
        away = [(axis, value, axis.tolerance * share * self._dice.between(-1, 1)) for axis, value in rows]
        return tuple(_inside(axis, value + by, places=3) for axis, value, by in away)

    def _section(self, values: Values, *, approach: bool) -> Section:
        rows = list(zip(self._axes, values, strict=True))
        section: Section = {}
        if any(not axis.slides for axis in self._axes):
            section["deg"] = [value for axis, value in rows if not axis.slides]
        heights = [(axis, value) for axis, value in rows if axis.slides]
        if heights:
            section["mm"] = in_file_mm([value for _, value in heights])
        for room in [axis.room(value) for axis, value in heights if axis.up][-1:]:
            if approach and room >= 1 and self._dice.chance(0.5):
                section["approach_mm"] = _down(room * self._dice.pick((0.1, 0.5, 1.0)))
        return section


def in_file_mm(values: Sequence[float]) -> float | list[float]:
    """The values of the sliding joints in the form of a file: a single one needs no list."""
    return values[0] if len(values) == 1 else list(values)


def may_have_rack(axes: Sequence[Axis]) -> bool:
    """True if stations by rule can name the first two joints: both turn, and there are two."""
    return len(axes) > 1 and not any(axis.slides for axis in axes[:2])


def draw_rack(dice: Dice, axes: Sequence[Axis]) -> tuple[Section, int]:
    """Stations by rule, and their number."""
    columns, rows = dice.pick(((1, 1), (1, 3), (2, 1), (2, 2), (3, 2), (3, 3)))
    first, second, *rest = axes
    section: Section = {
        "columns_q1_deg": [_inside(first, dice.between(first.lower, first.upper)) for _ in range(columns)],
        "rows_q2_deg": [_inside(second, dice.between(second.lower, second.upper)) for _ in range(rows)],
    }
    slides = [axis for axis in rest if axis.slides]
    if slides and dice.chance(0.7):
        heights = [_inside(axis, dice.between(axis.lower, axis.upper)) for axis in slides]
        section["mm"] = in_file_mm(heights)
        lifting = [(axis, value) for axis, value in zip(slides, heights, strict=True) if axis.up]
        for room in [axis.room(value) for axis, value in lifting][-1:]:
            if room >= 1 and dice.chance(0.5):
                section["approach_mm"] = _down(room / 2)
    return section, columns * rows


def _inside(axis: Axis, value: float, places: int = 1) -> float:
    return min(max(round(value, places), axis.lower), axis.upper)


def _down(value: float) -> float:
    return max(round(value - 0.05, 1), 0.1)
