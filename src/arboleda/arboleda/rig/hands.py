"""Hands: carries out an advice as a person would, with an operator's verb or at the machine itself."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.model.advice import Advice, Hand
from arboleda.model.messages import Verb

from .manual_work import ManualWork
from .world import World


def do(world: World, advice: Advice) -> None:
    """Do what is advised; work that a verb only declares as done by hand is done by hand first."""
    if isinstance(advice.do, Hand):
        HANDS[advice.do](world, advice.scope)
    elif advice.by_hand:
        BY_HAND[advice.do](world.manual, advice.scope)
    else:
        world.request_verb(advice.do, advice.scope, arguments=advice.arguments)


def _bring_back(world: World, robot: str) -> None:
    world.power_on(world.model.robots[robot].mqtt)


def _repair(world: World, robot: str) -> None:
    world.boards[world.model.robots[robot].mqtt].repair(round(world.now * 1e6))


def _reference(world: World, robot: str) -> None:
    world.manual.put_at_reference(robot)


def _check(world: World, zone: str) -> None:
    """Move out of the zone whoever may be in it, to its reference, which lies outside all zones."""
    holder = world.plant.zones.holder(zone)
    if holder in world.model.robots:  # a shared device has no reference, and is held by a cell
        world.manual.put_at_reference(holder)


def _free(world: World, device: str) -> None:
    """Get the machine out of the way, where it is not so already, as by opening its door.

    A lift is always in the way of one of two zones: it is moved out of the one in which it is.
    """
    board = world.model.robots[device].mqtt
    facts = world.boards[board].body.true_facts
    for lock in world.model.cell_of[device].interlocks_of(device):
        if any(facts.get(name) != value for name, value in lock.free_while):
            world.manual.set_facts(board, lock.free_while)
            return


def _take_out(world: World, place: str) -> None:
    _tell(world, Verb.UNLOAD, place)


def _put_in(world: World, place: str) -> None:
    _tell(world, Verb.LOAD, place)


def _tell(world: World, verb: Verb, place: str) -> None:
    """Do it, which is so once it is told."""
    cell, _, target = place.partition(" ")
    world.request_verb(verb, cell, arguments=(("place", target),))


BY_HAND: dict[Verb, Callable[[ManualWork, str], None]] = {
    Verb.HOME: ManualWork.home,
    Verb.RELEASE: ManualWork.release,
}
"""Deeds of a person at the machine, who then declares them."""
BEFOREHAND: dict[Verb, Callable[[ManualWork, str], None]] = {
    Verb.HOME: ManualWork.put_at_reference,
    Verb.RELEASE: ManualWork.take_out,
}
"""The same without what is declared."""
HANDS: dict[Hand, Callable[[World, str], None]] = {
    Hand.BRING_BACK: _bring_back,
    Hand.REPAIR: _repair,
    Hand.REFERENCE: _reference,
    Hand.CHECK: _check,
    Hand.FREE: _free,
    Hand.TAKE_OUT: _take_out,
    Hand.PUT_IN: _put_in,
    Hand.LEAVE_IN: _put_in,
}
