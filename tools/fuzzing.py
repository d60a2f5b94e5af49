"""Frame of the fuzzers: what a person types, how often which end came, and how long it took."""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable, Sequence
from random import Random
from typing import NoReturn

from arboleda.simulator.chance import Dice

BAD_INPUT = 2


def fuzz(run: Callable[[int, int], Counter[str]], usage: str | None, runs: int = 100_000) -> NoReturn:
    """Run it as often as is asked for, and say what came of it; `usage` answers any other words."""
    words = sys.argv[1:]
    if len(words) > 2 or not all(word.isdigit() for word in words):
        print(usage, file=sys.stderr)
        sys.exit(BAD_INPUT)
    runs, seed = (*map(int, words), *(runs, 1)[len(words) :])
    began = time.perf_counter()
    for what, count in sorted(run(runs, seed).items()):
        print(f"{count:8} {what}")
    print(f"{runs} runs of seed {seed} in {time.perf_counter() - began:.0f} s: nothing went wrong")
    sys.exit()


def rounds(runs: int, seed: int, attempt: Callable[[Random, int], str]) -> Counter[str]:
    """How often which end came of so many attempts, each with its number and a chance of its own.

    AssertionError with the number of the attempt that raised anything.
    """
    ends = Counter[str]()
    for number in range(runs):
        try:
            ends[attempt(Random(f"{seed}/{number}"), number)] += 1
        except Exception as error:  # noqa: BLE001 - whatever is raised fails the run
            fail(seed, number, error)
    return ends


def changed(
    data: bytes, chance: Random, odd: Sequence[bytes], *, head: int = 0, share: float = 0.0, most: int = 2048
) -> bytes:
    """At most `most` bytes of the data, with one to five changes: bytes lost, doubled or replaced.

    What replaces them is one of `odd`, or any bytes. That `share` of the changes is in the first `head`
    bytes, where a frame says what it is.
    """
    for _ in range(1 + int(chance.random() * 5)):
        at = int(chance.random() * (head if chance.random() < share else len(data) + 1))
        length = int(chance.random() * 9)
        kind = int(chance.random() * 4)
        if kind == 0:
            data = data[:at] + data[at + length :]
        elif kind == 1:
            data = data[:at] + data[at : at + length] + data[at:]
        elif kind == 2:
            data = data[:at] + chance.choice(odd) + data[at + length :]
        else:
            data = data[:at] + chance.randbytes(length) + data[at + length :]
    return data[:most]


def spoilt(dice: Dice, frame: bytes) -> bytes:
    """A frame with up to three mistakes: another byte or bit, bytes too many, or its end cut off."""
    changed = bytearray(frame)
    for _ in range(dice.below(4)):
        at = dice.below(len(changed))
        way = dice.below(4)
        if way == 0:
            changed[at] = dice.below(256)
        elif way == 1:
            changed = changed[: max(1, at)]
        elif way == 2:
            changed[at:at] = bytes(dice.below(256) for _ in range(4))
        else:
            changed[at] ^= 1 << dice.below(8)
    return bytes(changed)


def fail(seed: int, number: int, error: Exception) -> NoReturn:
    raise AssertionError(f"run {number} of seed {seed}: {type(error).__name__}: {error}") from error
