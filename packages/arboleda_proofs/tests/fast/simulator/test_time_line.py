"""The time line as the simulator follows it, for longer than a page keeps events."""

from __future__ import annotations

from typing import Any

from arboleda.views.chronicle import EVENTS
from arboleda_proofs.simulator.recorded.time_line import TimeLine


def shown(at: float, zone: str = "free", tasks: int = 0) -> dict[str, Any]:
    task = {"text": "x", "cell": None, "state": "done", "sentence": ""}
    rows = [{"id": f"t-{number}", **task} for number in range(tasks)]
    zones = [
        {"zone": "quiet", "state": "held", "robot": "ra1"},
        {"zone": "busy", "state": zone, "robot": None},
    ]
    empty: dict[str, Any] = {name: [] for name in ("acts", "interference", "cells", "robots")}
    return {"at": at, "tasks": rows, "zones": zones, **empty}


def test_the_last_event_is_known_also_where_pages_have_forgotten_it() -> None:
    line = TimeLine()
    for number in range(EVENTS + 10):
        line.see(shown(float(number), ("held", "free")[number % 2]))
    assert line.whole and line.last["zone", "quiet"]["what"] == "held"
    assert line.received == shown(EVENTS + 9.0, ("held", "free")[(EVENTS + 9) % 2])


def test_it_knows_that_it_missed_events() -> None:
    line = TimeLine()
    line.see(shown(0.0))
    line.see(shown(1.0, tasks=EVENTS + 1))
    assert not line.whole
