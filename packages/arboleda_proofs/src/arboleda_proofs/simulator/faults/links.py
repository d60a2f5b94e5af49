"""Faults of the lines between processes: each direction of a connection to the broker, and the hop between
plant and bridge.

Only delay and a held partition touch presence: MQTT never loses or overtakes it while a connection lasts.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from arboleda.rig.network import Line, Trouble, keeps_its_place
from arboleda.rig.world import World

from ..chance import Dice
from . import targets
from .board_site import BoardSite
from .kind import End, Fault, board_kind, kind, words
from .shared_effects import trouble

AT_ONCE = (0.0,)
WAYS = ("up", "down")
HOPS = ("to bridge", "to plant")
CUTS = ("held", "lost")  # what is sent meanwhile: TCP and reliable ROS 2 bring it later, short queues drop it


def _cut(ways: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(f"{way}, {cut}" for way in ways for cut in CUTS)


@board_kind(targets=targets.clients, words=words(*WAYS), seconds=(1.0, 30.0), amount=(0.01, 0.3))
def loss(world: BoardSite, fault: Fault) -> End:
    """A share of `amount` of the messages is lost one way."""
    dice = Dice(fault.seed, "loss")
    return trouble(_line(world, fault), _sparing(lambda _: () if dice.chance(fault.amount) else AT_ONCE))


@board_kind(targets=targets.clients, words=words(*WAYS), seconds=(1.0, 30.0), amount=(0.01, 0.5))
def duplicate(world: BoardSite, fault: Fault) -> End:
    """A share of `amount` of the messages comes twice one way, as QoS 1 allows."""
    dice = Dice(fault.seed, "duplicate")

    def twice(_: Any) -> tuple[float, ...]:
        return (0.0, dice.between(0.0, 0.3)) if dice.chance(fault.amount) else AT_ONCE

    return trouble(_line(world, fault), _sparing(twice))


@board_kind(targets=targets.clients, words=words(*WAYS), seconds=(1.0, 30.0), amount=(0.02, 0.5))
def reorder(world: BoardSite, fault: Fault) -> End:
    """Messages overtake each other one way: each is up to `amount` s late."""
    dice, line = Dice(fault.seed, "reorder"), _line(world, fault)
    calm = trouble(line, _sparing(lambda _: (dice.between(0.0, fault.amount),)))
    line.reorders += 1

    def end() -> None:
        calm()
        line.reorders -= 1

    return end


@board_kind(targets=targets.clients, words=words(*WAYS), seconds=(1.0, 20.0), amount=(0.005, 5.0))
def delay(world: BoardSite, fault: Fault) -> End:
    """Every message is `amount` s late one way."""
    return trouble(_line(world, fault), lambda _: (fault.amount,))


@board_kind(targets=targets.clients, words=words(*_cut(WAYS)), seconds=(0.2, 10.0))
def partition(world: BoardSite, fault: Fault) -> End:
    """Nothing gets through one way; what is sent meanwhile is held until the end, or lost."""
    return trouble(_line(world, fault), _sparing(_lose) if _loses(fault) else _hold(world, fault))


@kind(targets=targets.plant, words=words(*HOPS), seconds=(1.0, 20.0), amount=(0.005, 5.0))
def hop_delay(world: World, fault: Fault) -> End:
    """Every message between plant and bridge is `amount` s late one way."""
    return trouble(_hop(world, fault), lambda _: (fault.amount,))


@kind(targets=targets.plant, words=words(*HOPS), seconds=(1.0, 20.0), amount=(0.02, 1.0))
def hop_reorder(world: World, fault: Fault) -> End:
    """Topics between plant and bridge overtake each other one way: each message is up to `amount` s late."""
    dice = Dice(fault.seed, "hop_reorder")
    return trouble(_hop(world, fault), lambda _: (dice.between(0.0, fault.amount),))


@kind(targets=targets.plant, words=words(*_cut(HOPS)), seconds=(0.2, 10.0))
def hop_partition(world: World, fault: Fault) -> End:
    """Nothing gets through one way between plant and bridge; what is sent meanwhile is held, or lost."""
    return trouble(_hop(world, fault), _lose if _loses(fault) else _hold(world, fault))


def _line(world: BoardSite, fault: Fault) -> Line:
    client = world.broker.clients[fault.target]
    return client.up if _way(fault) == "up" else client.down


def _hop(world: World, fault: Fault) -> Line:
    return world.to_bridge if _way(fault) == "to bridge" else world.to_plant


def _way(fault: Fault) -> str:
    return fault.word.split(",")[0]


def _loses(fault: Fault) -> bool:
    return fault.word.endswith("lost")


def _lose(_: Any) -> tuple[float, ...]:
    return ()


def _hold(world: BoardSite, fault: Fault) -> Trouble:
    end = world.awake_s + fault.seconds
    return lambda _: (max(0.0, end - world.awake_s),)


def _sparing(makes: Callable[[Any], tuple[float, ...]]) -> Trouble:
    return lambda message: AT_ONCE if keeps_its_place(message) else makes(message)


KINDS = (loss, duplicate, reorder, delay, partition, hop_delay, hop_reorder, hop_partition)
