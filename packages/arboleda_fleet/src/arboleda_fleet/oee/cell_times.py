"""Times in which the cells did no work, and in which the plant ran, kept for the OEE."""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial

from arboleda.engine import Plant
from arboleda.extension import ArboledaError
from arboleda.model.cell_states import CellState
from arboleda.oee.figures import SEEN_S
from arboleda.store.time_table import TimeTable

LOG = logging.getLogger(__name__)
WORKS = frozenset({CellState.IDLE, CellState.EXECUTE})


class CellTimes:
    """CellTimes: writes changes into the store, in the plant's thread once a step's commands have left.

    If the store cannot be written, that is logged once, and nothing more is kept of this start: figures must
    not end a plant.
    """

    def __init__(self, times: TimeTable, clock: Callable[[], float]) -> None:
        self._times = times
        self._clock = clock
        self._version = -1
        self._noted_s = 0.0
        self._down: dict[str, CellState] = {}
        self._keeps = False

    def start(self) -> None:
        self._noted_s = now_s = self._clock()
        self._keeps = True
        self._kept(lambda times: times.began(now_s))

    def stepped(self, plant: Plant) -> None:
        """Keep the cells that stand since this step, and now and then that the plant runs."""
        if not self._keeps:
            return
        now_s = self._clock()
        if not 0 <= now_s - self._noted_s < SEEN_S:
            self._noted_s = now_s
            self._kept(lambda times: times.note_run(now_s))
        if plant.version == self._version:
            return
        self._version = plant.version
        for name, run in plant.cells.items():
            state = None if run.state in WORKS else run.state
            if state is not self._down.get(name):
                self._down.pop(name, None)
                if state is not None:
                    self._down[name] = state
                self._kept(partial(_stands, name, None if state is None else state.value, now_s))

    def stop(self) -> None:
        """Keep that the plant was ended on purpose, so that the time after it is not planned; idempotent."""
        self._kept(lambda times: times.note_run(self._clock(), ended=True))
        self._keeps = False

    def _kept(self, keep: Callable[[TimeTable], None]) -> None:
        if not self._keeps:
            return
        try:
            keep(self._times)
        except ArboledaError as error:
            self._keeps = False
            LOG.warning("the times of cells are not kept any more, `arboleda oee` lacks them: %s", error)


def _stands(cell: str, state: str | None, now_s: float, times: TimeTable) -> None:
    times.stands(cell, state, now_s)
