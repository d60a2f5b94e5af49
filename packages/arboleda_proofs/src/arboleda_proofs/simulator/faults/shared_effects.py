"""Effects that several faults may keep up at once: the last one that ends undoes them."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.rig.network import Line, Trouble

from .board_site import BoardSite
from .kind import End


def hold(world: BoardSite, what: str, whom: str, end: Callable[[], object]) -> End:
    """Keep `what` up at `whom` for one more fault; `end` is called when the last such fault ends."""
    world.holds[what, whom] += 1

    def release() -> None:
        world.holds[what, whom] -= 1
        if not world.holds[what, whom]:
            end()

    return release


def stall(world: BoardSite, process: str, seconds: float) -> End:
    """A process does nothing until all that stalls it has ended."""
    world.stall(process, seconds)
    return hold(world, "stall", process, lambda: world.go_on(process))


def trouble(line: Line, makes: Trouble) -> End:
    """Have a line treat its messages in this way until the fault ends."""
    line.troubles.append(makes)
    return lambda: line.troubles.remove(makes)
