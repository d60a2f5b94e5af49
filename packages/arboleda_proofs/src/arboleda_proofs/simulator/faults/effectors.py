"""Faults of an effector, of the part that it handles, and of its piece sensor, where boards report that."""

from __future__ import annotations

from typing import Any

from arboleda.rig.world import World

from ..chance import Dice
from . import targets
from .board_site import BoardSite
from .false_telemetry import deceive
from .kind import End, Fault, board_kind, kind, words
from .shared_effects import hold

SEES = {"a piece": 1, "nothing": 0}


@board_kind(targets=targets.hands, seconds=(1.0, 30.0))
def no_grip(world: BoardSite, fault: Fault) -> End:
    """An effector closes beside the part."""
    return _keep(world, fault, "grips", False)


@board_kind(targets=targets.hands, seconds=(1.0, 30.0))
def stuck_effector(world: BoardSite, fault: Fault) -> End:
    """An effector does not follow its switch."""
    return _keep(world, fault, "stuck", True)


@board_kind(targets=targets.hands, seconds=(1.0, 30.0))
def no_part(world: BoardSite, fault: Fault) -> End:
    """Nothing lies at the pick-up."""
    return _keep(world, fault, "supplied", False)


@board_kind(targets=targets.hands)
def lost_part(world: BoardSite, fault: Fault) -> None:
    """The part falls out of an effector, which does not notice."""
    targets.arm_body(world, fault.target).lose_piece()


@board_kind(targets=targets.hands)
def opened_effector(world: BoardSite, fault: Fault) -> None:
    """Somebody else opens an effector, and its board says that it is off."""
    world.manual.open_effector(fault.target)


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


def _keep(world: BoardSite, fault: Fault, attribute: str, value: bool) -> End:
    body = targets.arm_body(world, fault.target)
    setattr(body, attribute, value)
    return hold(world, attribute, fault.target, lambda: setattr(body, attribute, not value))


KINDS = (no_grip, stuck_effector, no_part, lost_part, opened_effector, piece_false, piece_flicker)
