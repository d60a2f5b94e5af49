"""Faults of an effector and of the part that it handles."""

from __future__ import annotations

from . import targets
from .board_site import BoardSite
from .kind import End, Fault, board_kind
from .shared_effects import hold


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


def _keep(world: BoardSite, fault: Fault, attribute: str, value: bool) -> End:
    body = targets.arm_body(world, fault.target)
    setattr(body, attribute, value)
    return hold(world, attribute, fault.target, lambda: setattr(body, attribute, not value))


KINDS = (no_grip, stuck_effector, no_part, lost_part, opened_effector)
