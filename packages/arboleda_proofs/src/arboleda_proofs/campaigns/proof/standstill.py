"""Standstill: a world in which nothing can happen any more unless somebody does something."""

from __future__ import annotations

import math

from arboleda.engine import CellRun
from arboleda.engine.inspection import ledger_of, teaching_of, walk_of
from arboleda.model.messages import Heartbeat
from arboleda_proofs.simulator.judged_world import JudgedWorld

LASTS_S = 2.5  # longer than a plant, a bridge or a board looks back that hears the others and is told nothing


class Standstill:
    """Standstill of a world: nothing is open in it, and for a while nothing was news.

    Then what comes is what came, a while later: each process does what follows from its state and from what
    it is told, and it is told the same, while none of its own times is still to come. What is asked about a
    longer time is asked only of a plant that is not heard (5 s), and where a command comes or fails (5 s).
    """

    def __init__(self, watched: JudgedWorld) -> None:
        self._watched, self._world = watched, watched.world
        self._since = self._world.now  # the last news
        self._last_state = (self._world.plant, -1)
        self._world.watchers.append(self._look)

    @property
    def lasts(self) -> bool:
        """True once nothing has been open, and nothing news, for so long that nothing will be."""
        return self._world.now - self._since >= LASTS_S and self._world.is_quiet and self._nothing_is_open

    @property
    def _nothing_is_open(self) -> bool:
        """True if no command is under way, no cell waits for a time, and no body moves or changes."""
        plant, bodies = self._world.plant, [board.body for board in self._world.boards.values()]
        return (
            not self._world.faults_active
            and ledger_of(plant).next_deadline == math.inf
            and not any(map(_waits, plant.cells.values()))
            and not any(body.moving or body.next_change_us is not None for body in bodies)
        )

    def _look(self) -> None:
        plant = self._world.plant
        state = (plant, plant.version)
        if state != self._last_state or self._watched.truth.changed or self._has_news:
            self._last_state, self._since = state, self._world.now

    @property
    def _has_news(self) -> bool:
        """True if anybody asked, was told or did anything in this step but say that they are there."""
        moment = self._world.moment
        done = moment.requests or moment.executed or moment.opened or moment.put_right
        lost = moment.last_words or moment.unkept or moment.undelivered or moment.late
        return bool(done or lost) or any(not isinstance(each, Heartbeat) for each in moment.sent)


def _waits(cell: CellRun) -> bool:
    """True for a cell that does something at a time; what a tree waited for that is over means nothing."""
    at_work = cell.tree is not None or walk_of(cell) is not None or teaching_of(cell) is not None
    return at_work and cell.due is not None
