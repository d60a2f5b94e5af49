"""What came of it: lines for people, JSON for programs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from arboleda_bench.result import percentile

from .campaign import Outcome
from .judge import AGAIN, FAILED, HELD, WENT_ON

SHOWN = 20  # sentences of a kind


def lines(outcome: Outcome) -> Iterator[str]:
    """The report."""
    verdict, kills = outcome.verdict, len(outcome.kills)
    yield f"{kills} kills, {outcome.at_start} of them while the plant started, in {outcome.seconds:.0f} s"
    if kills:
        yield f"  {outcome.seconds / kills:.1f} s for each"
    yield f"{outcome.accepted} tasks accepted: " + _counts(outcome.tasks)
    counted = (("lost", verdict.lost), ("doubled", verdict.doubled), ("dropped", verdict.dropped))
    for name, sentences in (*counted, ("moved by itself", verdict.moved), ("trouble", outcome.trouble)):
        yield f"{name}: {len(sentences)}"
        yield from (f"  {each}" for each in sentences[:SHOWN])
    left = sum(len(kill.running) for kill in outcome.kills)
    yield f"{left} tasks were at work when the plant was killed: " + _counts(
        {name: verdict.after.get(name, 0) for name in (WENT_ON, HELD, FAILED, AGAIN)}
    )
    yield f"parts put back onto the mobile robot: {verdict.put_back}"
    yield f"parts let go as an operator was advised to: {verdict.by_hand}"
    yield "what the attendant was advised and did: " + _counts(outcome.verbs)
    yield f"of that refused: {len(outcome.refused)}"
    yield from (f"  {each}" for each in outcome.refused[:SHOWN])
    for name, values in (("API", outcome.api_s), ("all robots", outcome.boards_s)):
        yield f"ready, {name}: " + (_times(values) if values else "never")


def as_json(outcome: Outcome) -> dict[str, Any]:
    """All of it."""
    known = asdict(outcome)
    for kill in known["kills"]:
        kill["running"] = sorted(kill["running"])
        kill["joined_at"] = kill["joined_at"] if math.isfinite(kill["joined_at"]) else None
    return {"ok": outcome.ok, **known}


def _counts(counts: dict[str, int]) -> str:
    return ", ".join(f"{name} {count}" for name, count in counts.items()) or "none"


def _times(values: Sequence[float]) -> str:
    return f"p50 {percentile(values, 50):.2f} s, p99 {percentile(values, 99):.2f} s, of {len(values)} starts"
