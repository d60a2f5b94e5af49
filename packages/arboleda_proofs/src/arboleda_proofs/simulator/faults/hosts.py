"""Faults of the two hosts of a plant and of their connection to the store; only with a simulated standby."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.model.plant_model import PlantModel
from arboleda.rig.hosts.hosts import NAMES, Hosts
from arboleda.rig.hosts.process import StorePath
from arboleda.rig.world import BRIDGE, PLANT, World

from ..checks import BadFaults
from . import targets
from .kind import End, Fault, kind, words
from .shared_effects import stall, trouble

LATE_S = 0.05  # after a process is thawed, what it had written to its socket leaves
SLOWEST, FASTEST = 0.965, 1.035  # of clocks beside the store's


def names(model: PlantModel) -> Sequence[str]:
    """Both hosts."""
    return NAMES


def _hosts(world: World) -> Hosts:
    if world.hosts is None:
        raise BadFaults("what befalls two hosts needs a standby")
    return world.hosts


@kind(targets=targets.plant, weight=0.0)
def leader_killed(world: World, fault: Fault) -> None:
    """The process that leads dies, its bridge with it; some time later it is started again, to wait."""
    _hosts(world).kill()


LATE = words("", "last packets late")


@kind(targets=targets.plant, words=LATE, seconds=(0.3, 20.0), amount=(0.01, 0.6), weight=0.0)
def leader_frozen(world: World, fault: Fault) -> End:
    """The leader is frozen; at times its last packets, of `amount` s, lie in its socket until it goes on."""
    ends: list[End] = []

    def thaw() -> None:
        for end in ends:
            end()

    def freeze(_: object = None) -> None:
        ends.extend(stall(world, process, fault.seconds) for process in (PLANT, BRIDGE))

    if not fault.word:
        freeze()
        return thaw
    line = world.broker.clients[BRIDGE].up
    free = trouble(line, lambda message: (fault.amount + fault.seconds + LATE_S,))

    def freeze_late(_: object) -> None:
        free()
        freeze()

    world.at(world.now + fault.amount, freeze_late)
    return thaw


@kind(targets=names, words=words(*(way.value for way in StorePath)), seconds=(0.2, 9.0), weight=0.0)
def store_cut(world: World, fault: Fault) -> End:
    """A host is cut off from the store, both ways or in one direction."""
    cuts, way = _hosts(world).hosts[fault.target].cuts, StorePath(fault.word)
    cuts[way] += 1

    def end() -> None:
        cuts[way] -= 1

    return end


@kind(targets=targets.store, seconds=(0.2, 6.0), weight=0.0)
def store_away(world: World, fault: Fault) -> End:
    """The store is away for everybody, as while it starts again; what it took it has."""
    hosts = _hosts(world).hosts.values()
    for each in hosts:
        each.cuts[StorePath.BOTH] += 1

    def end() -> None:
        for each in hosts:
            each.cuts[StorePath.BOTH] -= 1

    return end


@kind(targets=names, seconds=(1.0, 20.0), amount=(0.01, 1.5), weight=0.0)
def store_slow(world: World, fault: Fault) -> End:
    """The store takes `amount` s more to answer a host; one that takes too long counts as away."""
    host = _hosts(world).hosts[fault.target]
    host.delay_s += fault.amount

    def end() -> None:
        host.delay_s -= fault.amount

    return end


@kind(targets=targets.store, weight=0.0)
def store_answer_lost(world: World, fault: Fault) -> None:
    """A connection breaks after the store has taken something: it is sent once more, and taken once more."""
    _hosts(world).disk.forgets += 1


@kind(targets=names, words=words("faster", "slower"), seconds=(5.0, 60.0), amount=(0.001, 0.035), weight=0.0)
def clock_drift(world: World, fault: Fault) -> End:
    """The clock of a host runs faster or slower than that of the store by this share."""
    host = _hosts(world).hosts[fault.target]
    change = fault.amount if fault.word == "faster" else -fault.amount
    host.run(world.now, min(max(host.rate + change, SLOWEST), FASTEST))
    return lambda: host.run(world.now, 1.0)


@kind(targets=names, words=words("ahead", "behind"), amount=(1.0, 1000.0), weight=0.0)
def clock_step(world: World, fault: Fault) -> None:
    """Somebody sets the calendar of a host."""
    host = _hosts(world).hosts[fault.target]
    host.wall_s += fault.amount if fault.word == "ahead" else -fault.amount


@kind(targets=targets.plant, weight=0.0)
def handover(world: World, fault: Fault) -> None:
    """Somebody asks for a planned change of leaders."""
    _hosts(world).hand_over()


KINDS = (
    leader_killed,
    leader_frozen,
    store_cut,
    store_away,
    store_slow,
    store_answer_lost,
    clock_drift,
    clock_step,
    handover,
)
