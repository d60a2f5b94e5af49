"""Lines that a campaign prints: how far it is, how often what came, and what was wrong."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence

SHOWN = 20  # sentences of a kind


def stopwatch() -> Callable[[str], None]:
    """Prints each line behind the seconds since now."""
    began = time.monotonic()

    def say(line: str) -> None:
        print(f"{time.monotonic() - began:7.1f} s  {line}", flush=True)

    return say


def counts(counted: Mapping[str, int]) -> str:
    """Counts of ends, in one line."""
    return ", ".join(f"{name} {count}" for name, count in counted.items()) or "none"


def told(sentences: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """Number of sentences of each kind, and the first of them."""
    for name, of_kind in sentences.items():
        yield f"{name}: {len(of_kind)}"
        yield from (f"  {each}" for each in of_kind[:SHOWN])
