"""Chance from a seed: the same draws on every machine and every Python."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import TypeVar

T = TypeVar("T")


class Dice:
    """One stream of draws; streams of other names are independent of it.

    Only `Random.random()` is used: its sequence for a seed is promised not to change between versions.
    """

    def __init__(self, seed: int, *name: object) -> None:
        self.random = Random("/".join(map(str, (seed, *name)))).random

    def chance(self, probability: float) -> bool:
        return self.random() < probability

    def between(self, low: float, high: float) -> float:
        return low + (high - low) * self.random()

    def below(self, count: int) -> int:
        """A whole number from 0 to count - 1."""
        return int(self.random() * count)

    def pick(self, choices: Sequence[T]) -> T:
        return choices[self.below(len(choices))]
