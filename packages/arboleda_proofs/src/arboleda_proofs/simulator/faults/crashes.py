"""Faults in which the plant dies within a step: alone, with its machine, or on a full disk."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.rig.plant_process import Fuse, Side
from arboleda.rig.world import BRIDGE, PLANT, World

from ..chance import Dice
from . import targets
from .kind import End, Fault, kind, words
from .shared_effects import hold

SIDES = words(*(side.value for side in Side))
IN_ONE_PROCESS = 0.3  # the share of plants that die together with their bridge


@kind(targets=targets.plant, words=SIDES, seconds=(0.2, 12.0), amount=(1.0, 30.0), weight=0.0)
def crash_in_step(world: World, fault: Fault) -> End:
    """The plant's process dies on one side of its `amount`th commit or message, and is back at the end."""
    with_bridge = Dice(fault.seed, "bridge").chance(IN_ONE_PROCESS)
    return _dies(world, fault, world.plant_process.stop, with_bridge=with_bridge)


@kind(targets=targets.plant, words=SIDES, seconds=(0.5, 12.0), amount=(1.0, 30.0), weight=0.0)
def power_cut(world: World, fault: Fault) -> End:
    """So does the whole machine of plant and bridge, and what it had not synced is gone, but for a part."""

    def cut() -> None:
        world.plant_process.cut_power(Dice(fault.seed, "reached").below(world.disk.unsynced(world.now) + 1))

    return _dies(world, fault, cut, with_bridge=True)


@kind(targets=targets.plant, seconds=(0.5, 20.0), weight=0.0)
def full_disk(world: World, fault: Fault) -> End:
    """Nothing can be kept: at its next commit the plant, at times the bridge too, ends till there is room."""
    with_bridge = Dice(fault.seed, "bridge").chance(IN_ONE_PROCESS)
    ends: list[End] = [hold(world, "full", "disk", lambda: _make_room(world))]
    ends.append(hold(world, "down", PLANT, world.plant_process.start))

    def gone() -> None:
        if not with_bridge:
            return
        if world.bridge is not None:
            world.stop_bridge()
        if ends:
            ends.append(hold(world, "down", BRIDGE, lambda: _start_bridge(world)))
        elif not world.holds["down", BRIDGE]:
            world.start_bridge()

    world.disk.full = True
    world.plant_process.when_gone.append(gone)

    def end() -> None:
        called = [*ends]
        ends.clear()
        for each in called:
            each()
        if world.is_on(PLANT) and gone in world.plant_process.when_gone:
            world.plant_process.when_gone.remove(gone)

    return end


@kind(targets=targets.plant, seconds=(0.5, 20.0), amount=(0.1, 10.0), weight=0.0)
def slow_disk(world: World, fault: Fault) -> End:
    """Each sync takes `amount` s: a plant whose command needs one does nothing meanwhile; it leaves late."""
    world.disk.slow.append(fault.amount)
    return lambda: world.disk.slow.remove(fault.amount)


def _make_room(world: World) -> None:
    world.disk.full = False


def _dies(world: World, fault: Fault, die: Callable[[], None], *, with_bridge: bool) -> End:
    ends: list[End] = [hold(world, "down", PLANT, world.plant_process.start)]

    def burn() -> None:
        die()
        if with_bridge:
            if world.bridge is not None:
                world.stop_bridge()
            ends.append(hold(world, "down", BRIDGE, lambda: _start_bridge(world)))

    fuse = Fuse(round(fault.amount), Side(fault.word), burn)
    world.plant_process.fuses.append(fuse)

    def end() -> None:
        if fuse in world.plant_process.fuses:
            world.plant_process.fuses.remove(fuse)
        for each in ends:
            each()

    return end


def _start_bridge(world: World) -> None:
    if world.bridge is None:
        world.start_bridge()


KINDS = (crash_in_step, power_cut, full_disk, slow_disk)
COUNTED = (crash_in_step.name, power_cut.name)  # their amount is a number of commits and messages
