"""Report of a campaign: lines for people, JSON for programs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from frame.telling import counts, told

from .campaign import Outcome
from .judge import AGAIN, FAILED, HELD, WENT_ON
from .summary import spread


def lines(outcome: Outcome) -> Iterator[str]:
    """The report."""
    verdict, kills = outcome.verdict, len(outcome.kills)
    yield f"{kills} kills, {outcome.at_start} of them while the plant started, in {outcome.seconds:.0f} s"
    if kills:
        yield f"  {outcome.seconds / kills:.1f} s for each"
    yield f"{outcome.damages} damages to copies of the memory after these kills"
    yield from told({"unnoticed": outcome.unnoticed})
    yield f"{outcome.accepted} tasks accepted: " + counts(outcome.tasks)
    yield from told({**verdict.wrong, "trouble": outcome.trouble})
    left = sum(len(kill.running) for kill in outcome.kills)
    yield f"{left} tasks were at work when the plant was killed: " + counts(
        {name: verdict.after.get(name, 0) for name in (WENT_ON, HELD, FAILED, AGAIN)}
    )
    yield f"parts put back onto the mobile robot: {verdict.put_back}"
    yield f"parts let go as an operator was advised to: {verdict.by_hand}"
    yield "what the attendant was advised and did: " + counts(outcome.verbs)
    yield from told({"of that refused": outcome.refused})
    for name, values in (("API", outcome.api_s), ("all robots", outcome.boards_s)):
        yield f"ready, {name}: " + (f"{spread(values)}, of {len(values)} starts" if values else "never")


def as_json(outcome: Outcome) -> dict[str, Any]:
    """All of it."""
    known = asdict(outcome)
    for kill in known["kills"]:
        kill["running"] = sorted(kill["running"])
        kill["joined_at"] = kill["joined_at"] if math.isfinite(kill["joined_at"]) else None
    return {"ok": outcome.ok, **known}
