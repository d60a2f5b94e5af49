"""Pairs of faults in one run, the most likely ones first; a budget takes a sample, as there are too many."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import blake2b
from itertools import islice, product

from arboleda_proofs.simulator.faults import KINDS, Fault

from .forks import Walk
from .instants import Instant
from .proof import Proof, Proved, proved_by
from .proof_tally import Breaks, Case, shortest
from .scenario import Scenario

TOGETHER = 16  # second faults of a portion, which share the run before the first one
Tick = Callable[[], None]
Turn = tuple[int, int, float, int]  # scenario, number of the first fault, weight of the second ones, round


@dataclass(frozen=True, kw_only=True)
class PairProof:
    """PairProof: portions of pairs, each one first fault with some that begin later or at the same instant.

    The likelihood of a pair is that of its two kinds where seeds draw them; of pairs that are as likely the
    order is arbitrary, and always the same.
    """

    proof: Proof

    def __reduce__(self) -> tuple[Callable[[Proof], PairProof], tuple[Proof]]:
        return _of, (self.proof,)

    @cached_property
    def total(self) -> int:
        """The number of all pairs."""
        return sum(len(singles) * (len(singles) - 1) // 2 for singles in self._singles)

    def scenario(self, number: int) -> Scenario:
        """The scenario of the portion of this number."""
        return self.proof.calm[self._turn(number)[0]].scenario

    def name(self, number: int) -> str:
        """The name of the portion of this number: the number, and its faults with their times as one hash."""
        faults = blake2b(repr(self.pairs(number)).encode(), digest_size=16).hexdigest()
        return f"pairs {number} | {self.scenario(number).name} | {faults}"

    def number(self, name: str) -> int:
        """The number of the portion of this name; ValueError where that one has another name."""
        word, _, number = name.partition(" | ")[0].partition(" ")
        if word != "pairs" or self.name(int(number)) != name:
            raise ValueError("another portion")
        return int(number)

    def count(self, number: int) -> int:
        """The number of runs of the portion of this number."""
        return len(self.pairs(number))

    def numbers(self) -> Iterator[int]:
        """The numbers of all portions."""
        number = 0
        while self._reaches(number):
            yield number
            number += 1

    def pairs(self, number: int) -> list[tuple[Fault, Fault]]:
        """The pairs of the portion of this number."""
        row, first, weight, turn = self._turn(number)
        singles, pool = self._singles[row], self._by_weight[row].get(weight, [])
        start = first * 7919 % max(len(pool), 1)  # so that firsts do not all meet the same ones
        later = (each for each in (*pool[start:], *pool[:start]) if each > first)
        chosen = islice(later, turn * TOGETHER, (turn + 1) * TOGETHER)
        return [(singles[first][1], singles[each][1]) for each in chosen]

    def instant(self, number: int) -> Instant:
        """The instant at which the first fault of a portion begins."""
        row, first, _, _ = self._turn(number)
        return self._singles[row][first][0]

    def row(self, number: int) -> int:
        """The number of the calm run of a portion."""
        return self._turn(number)[0]

    def run(self, seed: int, *, tick: Tick | None = None) -> Proved:
        """Run all pairs of the portion of this number."""
        calm = self.proof.calm[self.row(seed)]
        walk = Walk(self.proof.model, calm)
        runs = walk.runs(self.pairs(seed), tick or (lambda: None))
        return proved_by(seed, runs, walk.spent())

    @cached_property
    def _singles(self) -> list[list[tuple[Instant, Fault]]]:
        return [self.proof.singles(row) for row in range(len(self.proof.calm))]

    @cached_property
    def _by_weight(self) -> list[dict[float, list[int]]]:
        """For each scenario the numbers of its faults by the weight of their kind, each list shuffled."""
        return [_by_weight(singles) for singles in self._singles]

    @cached_property
    def _known(self) -> list[Turn]:
        return []

    @cached_property
    def _turns(self) -> Iterator[Turn]:
        return self._in_turn()

    def _in_turn(self) -> Iterator[Turn]:
        weights = sorted({weight for each in self._by_weight for weight in each}, reverse=True)
        for one, other in sorted(product(weights, weights), key=lambda both: -both[0] * both[1]):
            most = max(len(each.get(other, ())) for each in self._by_weight)
            for turn in range(-(-most // TOGETHER)):
                for row, pools in enumerate(self._by_weight):
                    yield from ((row, first, other, turn) for first in pools.get(one, ()))

    def _reaches(self, number: int) -> bool:
        self._known.extend(islice(self._turns, max(0, number + 1 - len(self._known))))
        return number < len(self._known)

    def _turn(self, number: int) -> Turn:
        if not self._reaches(number):
            raise ValueError(f"there is no portion {number}")
        return self._known[number]


@dataclass(kw_only=True)
class PairTally:
    """PairTally: what came of the pairs of all portions that are `proved`, by number."""

    pairs: PairProof
    proved: dict[int, Proved] = field(default_factory=dict)

    @property
    def runs(self) -> int:
        """The number of pairs so far."""
        return sum(len(each.rows) for each in self.proved.values())

    def cases(self) -> Iterator[Case]:
        """All cases, in the order of the portions."""
        for number, proved in sorted(self.proved.items()):
            for (fault, then), outcome in zip(self.pairs.pairs(number), proved.each, strict=True):
                yield Case(
                    scenario=self.pairs.scenario(number),
                    row=self.pairs.row(number),
                    instant=self.pairs.instant(number),
                    fault=fault,
                    then=then,
                    outcome=outcome,
                )

    def breaches(self, known: frozenset[Breaks]) -> list[tuple[Case, int]]:
        """For each invariant that a recipe broke, and not by a single fault already, its earliest case."""
        return shortest(self.cases(), known)


def _of(proof: Proof) -> PairProof:
    return PairProof(proof=proof)


def _by_weight(singles: list[tuple[Instant, Fault]]) -> dict[float, list[int]]:
    found: dict[float, list[int]] = {}
    for number in sorted(range(len(singles)), key=lambda each: _shuffled(singles[each][1])):
        found.setdefault(KINDS[singles[number][1].kind].weight, []).append(number)
    return found


def _shuffled(fault: Fault) -> bytes:
    return blake2b(repr(fault).encode(), digest_size=8).digest()
