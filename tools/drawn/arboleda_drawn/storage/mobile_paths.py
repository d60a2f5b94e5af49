"""Paths of a mobile robot: of one node, there and back, all over the grid."""

from __future__ import annotations

from arboleda.kinds.floor import Placement
from arboleda.kinds.mobile import Grid
from arboleda_proofs.simulator.chance import Dice

from .poses import Section

GRID = Grid(origin=Placement(x=0.0, y=0.0), pitch=1.0)
LENGTHS = (1, 1, 2, 3, 4, 6)
LETTERS = "0123456789ABCXYZabcxyz"


def draw_paths(dice: Dice) -> Section:
    """Some paths by their codes."""
    codes = {(dice.pick(LETTERS) + dice.pick(LETTERS)).upper(): None for _ in range(1 + dice.below(4))}
    return {dice.pick((code, code.lower())): _path(dice) for code in codes}


def _path(dice: Dice) -> list[int]:
    nodes = [dice.below(GRID.size)]
    for _ in range(dice.pick(LENGTHS) - 1):
        nodes.append(dice.pick(GRID.neighbours(nodes[-1])))
    return [*nodes, *nodes[-2::-1]] if dice.chance(0.25) else nodes
