"""Faults of a piece sensor; only for boards that report it."""

from __future__ import annotations

from typing import Any

from arboleda.rig.world import World

from ..chance import Dice
from . import targets
from .false_telemetry import deceive
from .kind import End, Fault, kind, words

SEES = {"a piece": 1, "nothing": 0}


@kind(targets=targets.feelers, words=words(*SEES), seconds=(0.5, 15.0))
def piece_false(world: World, fault: Fault) -> End:
    """A piece sensor sees the same whatever is there."""
    return deceive(world, fault.target, ("piece",), lambda fields: {**fields, "pieza": SEES[fault.word]})


@kind(targets=targets.feelers, seconds=(0.5, 15.0), amount=(0.1, 0.9))
def piece_flicker(world: World, fault: Fault) -> End:
    """A piece sensor is wrong now and then; `amount` is the share of wrong values."""
    dice = Dice(fault.seed, "flicker")

    def flicker(row: dict[str, Any]) -> dict[str, Any]:
        wrong = dice.chance(fault.amount) and "pieza" in row
        return {**row, "pieza": 1 - row["pieza"]} if wrong else row

    return deceive(world, fault.target, ("piece",), flicker)


KINDS = (piece_false, piece_flicker)
