"""What boards say and cannot be believed: for as long as it is said, under way, or remembered."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence

from .network import Line
from .world import BRIDGE, PLANT, World

MOMENT_S = 0.1
NOBODY = ""
Stage = tuple[Line, str]  # a line that a lie takes, and who reads at its end
Done = Callable[[], None]


def begin_to_deceive(world: World, board: str, whats: Sequence[str]) -> Done:
    """Note in `world.deceptions` that a board deceives about `whats`; what is called when it stops.

    The note stays until no such lie is under way and none that was heard can still be believed.
    """
    for what in whats:
        world.deceptions[board, what] += 1

    def forget() -> None:
        for what in whats:
            world.deceptions[board, what] -= 1
        world.deceptions += Counter()  # without those that are over

    clients = world.broker.clients
    way = [(clients[board].up, NOBODY), (clients[BRIDGE].down, BRIDGE), (world.to_plant, PLANT)]
    return lambda: _follow(world, way, forget)


def _follow(world: World, way: Sequence[Stage], done: Done) -> None:
    """Call `done` when the last lie has gone this way, and is stale even if nothing came after it."""
    if way:
        world.at(way[0][0].busy_until, lambda _: _wait_for_reader(world, way, done))
    else:
        world.at(world.now + world.model.timing.stale_after_s + MOMENT_S, lambda _: done())


def _wait_for_reader(world: World, way: Sequence[Stage], done: Done) -> None:
    if world.is_stalled(way[0][1]):
        world.at(world.now + MOMENT_S, lambda _: _wait_for_reader(world, way, done))
    else:
        _follow(world, way[1:], done)
