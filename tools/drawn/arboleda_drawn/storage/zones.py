"""Shared zones of a drawn plant: over cells or within one, of poses, of moves or of both."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda_proofs.simulator.chance import Dice

from .cells import DrawnCell
from .poses import Section

ZONES = (0, 0, 1, 1, 2, 3)


def draw_zones(dice: Dice, cells: Sequence[DrawnCell], shared: Section) -> Section:
    """Zones by name; `shared` are the sections at the top of the file."""
    drawn = {f"zone_{number}": _zone(dice, cells, shared) for number in range(1, dice.pick(ZONES) + 1)}
    return {name: zone for name, zone in drawn.items() if zone}


def _zone(dice: Dice, cells: Sequence[DrawnCell], shared: Section) -> Section:
    section: Section = {}
    spots = [
        (cell, pose) for cell in cells for pose in cell.poses if pose not in ("home", cell.place(shared))
    ]
    inside = [f"{cell.name} {pose}" for cell, pose in spots if dice.chance(0.25)]
    if inside:
        section["poses"] = inside
    moves = [move for cell in cells if dice.chance(0.5) for move in _moves(dice, cell, inside)]
    if moves:
        section["moves"] = moves
    return section


def _moves(dice: Dice, cell: DrawnCell, inside: Sequence[str]) -> list[list[str]]:
    """Some moves of a cell between poses outside, each once."""
    free = [name for pose in cell.poses if (name := f"{cell.name} {pose}") not in inside]
    pairs = [[a, b] for index, a in enumerate(free) for b in free[index + 1 :] if dice.chance(0.2)]
    return [pair if dice.chance(0.5) else pair[::-1] for pair in pairs]
