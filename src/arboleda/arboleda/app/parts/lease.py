"""Goes on leading a plant whose memory several hosts reach."""

from __future__ import annotations

import logging
import threading

from arboleda.adapters import clock
from arboleda.adapters.plant_memory import PlantMemory, Superseded
from arboleda.model.errors import ArboledaError

from .part import Crash

LOG = logging.getLogger(__name__)
PATIENCE_S = 3.0


class LeasePart:
    """Says again and again that this process leads; the plant ends where another one does."""

    def __init__(self, memory: PlantMemory, renew_s: float, crash: Crash) -> None:
        self._memory = memory
        self._renew_s = renew_s
        self._crash = crash
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._lead, name="lease", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._ending.set()
        if self._thread.ident is not None and self._thread is not threading.current_thread():
            self._thread.join(PATIENCE_S)

    def _lead(self) -> None:
        away_since: float | None = None
        while not self._ending.wait(self._renew_s):
            try:
                self._memory.renew()
            except Superseded as error:
                self._crash("lease", error)
                return
            except ArboledaError as error:
                if away_since is None:
                    away_since = clock.seconds()
                    LOG.warning("%s", error)
            else:
                if away_since is not None:
                    LOG.warning("the store is reached again, after %.1f s", clock.seconds() - away_since)
                away_since = None
