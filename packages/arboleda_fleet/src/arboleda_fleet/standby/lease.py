"""Lease on a plant whose memory several hosts reach: this process leads it until another takes over."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable

from arboleda.adapters import clock
from arboleda.extension import ArboledaError
from arboleda.runtime.parts.part import Crash
from arboleda.store.lead import Superseded
from arboleda.store.plant_memory import PlantMemory

LOG = logging.getLogger(__name__)
PATIENCE_S = 3.0


class LeasePart:
    """Says again and again that this process leads; the plant ends where another one does.

    At its end it gives the memory back, so that a standby begins at once: no part that writes may end later.
    If somebody wants another leader, `hand_over` is called once, in a thread of its own.
    """

    def __init__(
        self, memory: PlantMemory, renew_s: float, crash: Crash, hand_over: Callable[[], None]
    ) -> None:
        self._memory = memory
        self._renew_s = renew_s
        self._crash = crash
        self._handing = threading.Thread(target=hand_over, name="handover", daemon=True)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._lead, name="lease", daemon=True)
        self._away_since: float | None = None

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._ending.set()
        for thread in (self._thread, self._handing):
            if thread.ident is not None and thread is not threading.current_thread():
                thread.join(PATIENCE_S)
        self._memory.close()

    def _lead(self) -> None:
        while not self._ending.wait(self._renew_s):
            try:
                wanted = self._memory.lead.renew()
            except Superseded as error:
                self._crash("lease", error)
                return
            except ArboledaError as error:
                self._is_away(error)
                continue
            self._is_there()
            if wanted and self._handing.ident is None:
                self._handing.start()

    def _is_away(self, error: ArboledaError) -> None:
        if self._away_since is None:
            self._away_since = clock.seconds()
            LOG.warning("%s", error)

    def _is_there(self) -> None:
        if self._away_since is not None:
            LOG.warning("the store is reached again, after %.1f s", clock.seconds() - self._away_since)
        self._away_since = None
