"""Cycles of a run: a task that ends is one if it has told a device, or a person, to do something."""

from __future__ import annotations

from arboleda.engine.inspection import ledger_of
from arboleda.rig.world import World


def has_told(world: World, cell: str | None, since: float) -> bool:
    """True where a cell has told somebody to do something since then, as far as the running plant knows."""
    last = ledger_of(world.plant).last_sent.values()
    return any(each.cell == cell and each.sent_at >= since for each in last)
