"""Book of the false reports of boards, kept for as long as one is sent, under way, or believed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence

from arboleda.rig.network import Line
from arboleda.rig.world import BRIDGE, PLANT, World

MOMENT_S = 0.1
NOBODY = ""
Stage = tuple[Line, str]  # a line that a lie takes, and who reads at its end
Done = Callable[[], None]


def begin_to_deceive(world: World, board: str, whats: Sequence[str]) -> Done:
    """Note that a board deceives about `whats`; return the call that ends the deception.

    The note stays until no false report is under way and none that was received can still be believed.
    """
    for what in whats:
        world.deceptions[board, what] += 1

    def forget() -> None:
        for what in whats:
            world.deceptions[board, what] -= 1
        world.deceptions += Counter()  # drops those at 0, which are over

    clients = world.broker.clients
    way = [(clients[board].up, NOBODY), (clients[BRIDGE].down, BRIDGE), (world.to_plant, PLANT)]
    return lambda: _follow(world, way, forget)


def _follow(world: World, way: Sequence[Stage], done: Done) -> None:
    """Call `done` when the last false report has passed this line and must be stale."""
    if way:
        world.at(way[0][0].busy_until, lambda _: _wait_for_reader(world, way, done))
    else:
        world.at(world.now + world.model.timing.stale_after_s + MOMENT_S, lambda _: done())


def _wait_for_reader(world: World, way: Sequence[Stage], done: Done) -> None:
    if world.is_stalled(way[0][1]):
        world.at(world.now + MOMENT_S, lambda _: _wait_for_reader(world, way, done))
    else:
        _follow(world, way[1:], done)
