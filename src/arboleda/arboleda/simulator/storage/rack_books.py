"""Invariants of racks: what the plant has stored, by the tasks that put it there."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.model.messages import Fact

from ..invariants.invariant import Look, Trigger, invariant


@invariant(Trigger.TOLD)
def racks_hold_what_was_put(look: Look) -> Iterator[str]:
    """A station of whose task the plant has said that it is done has a part until somebody takes it out, and
    none has one that no task of a shipped recipe was to fill.
    """
    racks, kept = look.record.racks, look.world.memory.get(Fact.STORED, {})
    for name, cell in look.record.cells.items():
        if name not in racks.cells or name in racks.of_others or look.world.recipes:
            continue
        stored, full, may_be_full = cell.context.stations.stored, racks.full[name], racks.may_be_full(name)
        if not full <= stored <= may_be_full:
            yield f"{name} has parts in {sorted(stored)}, and they were put into {sorted(full)}"
        if {int(number) for number in kept.get(name, "").split()} != stored:
            yield f"{name} has parts in {sorted(stored)}, kept is {kept.get(name)!r}"


RACKS = (racks_hold_what_was_put,)
