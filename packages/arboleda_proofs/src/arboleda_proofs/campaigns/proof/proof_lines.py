"""Lines for a program that reads along: progress of a proof, breaches as they are met, then the answer."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Protocol, TextIO

from .outcome import plain
from .proof import Proof, Proved

EVERY_S = 0.5  # between two lines of progress
STANDARD_OUTPUT = "-"


class Reads(Protocol):
    """Reader of progress: `done` of `total` runs, None where their number is not known yet."""

    def __call__(self, done: int, total: int | None) -> None: ...


class ProofLines:
    """ProofLines: writes a JSON object per line to `out`, one of `progress`, `broken` and `answer`; nothing
    where nobody reads along.
    """

    def __init__(self, out: TextIO | None) -> None:
        self._out = out

    @contextmanager
    def progress(self, phase: str) -> Iterator[Reads]:
        """The function that takes the progress of a phase, and writes it now and then."""
        began, last = time.monotonic(), 0.0

        def show(done: int, total: int | None) -> None:
            nonlocal last
            now = time.monotonic()
            if done == total or now - last >= EVERY_S:
                last = now
                seconds = round(now - began, 1)
                self._write("progress", {"phase": phase, "done": done, "of": total, "seconds": seconds})

        yield show

    def broken(self, proof: Proof, proved: Proved) -> None:
        """Write the first fault of a portion that broke an invariant."""
        portion = proof.portions[proved.number]
        for fault, outcome in zip(proof.faults(portion), proved.each, strict=True):
            if outcome.broken is not None:
                task, instant = proof.scenario(proved.number).name, proof.instant(portion).name
                row = {"task": task, "instant": instant, "kind": fault.kind, "target": fault.target}
                self._write("broken", row | {"outcome": plain(outcome)})
                return

    def answer(self, content: dict[str, Any]) -> None:
        """Write the whole answer."""
        self._write("answer", content)

    def _write(self, sort: str, content: dict[str, Any]) -> None:
        if self._out is not None:
            self._out.write(json.dumps({sort: content}, ensure_ascii=False) + "\n")
            self._out.flush()
