"""Faults of the processes beside the boards: broker, bridge and plant."""

from __future__ import annotations

from arboleda.rig.network import keeps_its_place
from arboleda.rig.world import BRIDGE, PLANT, World

from . import targets
from .kind import End, Fault, kind, words
from .shared_effects import hold, stall, trouble


@kind(targets=targets.broker, seconds=(0.0, 5.0), weight=0.5)
def broker_restart(world: World, fault: Fault) -> End:
    """The broker dies with all it retained, and is back after a while."""
    if world.broker.is_up:
        world.stop_broker()
    return hold(world, "down", "broker", world.start_broker)


@kind(targets=targets.clients, seconds=(0.05, 2.0))
def lost_queue(world: World, fault: Fault) -> End:
    """The broker's queue for a client overflows: what is in it or comes is lost, though it is connected."""
    client = world.broker.clients[fault.target]
    client.queue += 1
    return trouble(client.down, lambda message: (0.0,) if keeps_its_place(message) else ())


@kind(targets=targets.bridge, seconds=(0.0, 3.0), weight=0.5)
def bridge_restart(world: World, fault: Fault) -> End:
    """The bridge's process dies, and is back after a while."""
    if world.bridge is not None:
        world.stop_bridge()
    return hold(world, "down", BRIDGE, lambda: _start_bridge(world))


def _start_bridge(world: World) -> None:
    if world.bridge is None:
        world.start_bridge()


@kind(targets=targets.bridge, seconds=(0.005, 5.0))
def bridge_stall(world: World, fault: Fault) -> End:
    """The bridge does nothing for a while; what reaches it waits."""
    return stall(world, BRIDGE, fault.seconds)


@kind(targets=targets.plant, seconds=(0.005, 5.0))
def plant_stall(world: World, fault: Fault) -> End:
    """The plant's process does nothing for a while; what reaches it waits."""
    return stall(world, PLANT, fault.seconds)


@kind(targets=targets.plant, words=words("plant", "machine"), seconds=(1.0, 6.0), amount=(0.001, 86_400.0))
def plant_freeze(world: World, fault: Fault) -> End:
    """The plant is frozen, alone or with the bridge; up to a day passes at once then if no body changes."""
    frozen = (PLANT, BRIDGE) if fault.word == "machine" else (PLANT,)
    ends = [stall(world, process, fault.seconds) for process in frozen]

    def thaw() -> None:
        if all(board.body.next_change_us is None for board in world.boards.values()):
            world.skip(fault.amount)
        for end in ends:
            end()

    return thaw


@kind(targets=targets.plant, weight=0.0)
def plant_crash(world: World, fault: Fault) -> None:
    """The plant's process dies between two steps, and starts anew at once."""
    world.crash(PLANT)


KINDS = (broker_restart, lost_queue, bridge_restart, bridge_stall, plant_stall, plant_freeze, plant_crash)
