"""Handover: a planned change of leaders, in which one holds its cells and the next goes on with them."""

from __future__ import annotations

import logging
import threading
from collections.abc import Sequence
from contextlib import suppress

from arboleda.adapters import clock
from arboleda.departures.leading import all_stand, at_work
from arboleda.extension import ArboledaError
from arboleda.model.messages import Verb
from arboleda.runtime.parts.orchestrator import Orchestrator

LOG = logging.getLogger("arboleda.handover")
HELD_S = 10.0  # by then what is held stands still
HEARD_S = 30.0  # by then robots are heard
LOOK_S = 0.05
PATIENCE_S = 3.0


def hold_all(plant: Orchestrator) -> list[str]:
    """Hold every cell that is at work, wait until all of them stand, and return their names."""
    working = at_work(_states(plant))
    held = [name for name in working if plant.operate(Verb.HOLD, name).result(HELD_S).refusal is None]
    patience = clock.seconds() + HELD_S
    while not all_stand(_states(plant), held) and clock.seconds() < patience:
        threading.Event().wait(LOOK_S)
    return held


def _states(plant: Orchestrator) -> dict[str, str]:
    return {row["name"]: row["state"] for row in plant.screens.snapshot()["cells"]}


class CellResumption:
    """Resumes the cells that the leader before held for the change alone, once their robots are heard."""

    def __init__(self, plant: Orchestrator, cells: Sequence[str], epoch: int) -> None:
        self._plant = plant
        self._cells = cells
        self._epoch = epoch
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._go_on, name="going on", daemon=True)

    def start(self) -> None:
        LOG.warning("this process leads the plant now, under number %d", self._epoch)
        if self._cells:
            self._thread.start()

    def stop(self) -> None:
        self._ending.set()
        if self._thread.ident is not None:
            self._thread.join(PATIENCE_S)

    def _go_on(self) -> None:
        left, patience = dict.fromkeys(self._cells, ""), clock.seconds() + HEARD_S
        while left and clock.seconds() < patience and not self._ending.wait(LOOK_S):
            for name in list(left):
                with suppress(ArboledaError, TimeoutError):
                    refusal = self._plant.operate(Verb.RESUME, name).result(PATIENCE_S).refusal
                    left[name] = str(refusal)
                    if refusal is None:
                        del left[name]
        for name, why in left.items():
            LOG.warning("%s stays held after the change of leaders: %s", name, why)
