"""Faults of an effector and of the part that it handles."""

from __future__ import annotations

from ..world import World
from . import targets
from .kind import End, Fault, kind
from .shared_effects import hold


@kind(targets=targets.hands, seconds=(1.0, 30.0))
def no_grip(world: World, fault: Fault) -> End:
    """An effector closes beside the part."""
    return _keep(world, fault, "grips", False)


@kind(targets=targets.hands, seconds=(1.0, 30.0))
def stuck_effector(world: World, fault: Fault) -> End:
    """An effector does not follow its switch."""
    return _keep(world, fault, "stuck", True)


@kind(targets=targets.hands, seconds=(1.0, 30.0))
def no_part(world: World, fault: Fault) -> End:
    """Nothing lies at the pick-up."""
    return _keep(world, fault, "supplied", False)


@kind(targets=targets.hands)
def lost_part(world: World, fault: Fault) -> None:
    """The part falls out of an effector, which does not notice."""
    targets.arm_body(world, fault.target).lose_piece()


@kind(targets=targets.hands)
def opened_effector(world: World, fault: Fault) -> None:
    """Somebody else opens an effector, and its board says that it is off."""
    world.open_effector(fault.target)


def _keep(world: World, fault: Fault, attribute: str, value: bool) -> End:
    body = targets.arm_body(world, fault.target)
    setattr(body, attribute, value)
    return hold(world, attribute, fault.target, lambda: setattr(body, attribute, not value))


KINDS = (no_grip, stuck_effector, no_part, lost_part, opened_effector)
