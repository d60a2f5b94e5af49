"""ROS domains for processes that run side by side on one machine, as tests and benchmarks do."""

from __future__ import annotations

import os
import tempfile
from itertools import count
from pathlib import Path

from arboleda.host.locks import lock
from arboleda.host.machine import own_mark
from arboleda.model.errors import StartError

LAST = 101  # the DDS ports of higher ROS domains lie among the ports that Linux hands out
_begin = count(os.getpid())


class Domain:
    """A ROS domain id that nobody else on this machine gets until `close`; each begins at another id."""

    def __init__(self) -> None:
        folder = Path(tempfile.gettempdir(), f"arboleda-ros-domains-{own_mark()}")
        folder.mkdir(exist_ok=True)
        begin = next(_begin)
        for id in (((begin + n) % LAST) + 1 for n in range(LAST)):
            if self._reserved(folder / str(id)):
                self.id = id
                return
        raise StartError(f"all {LAST} ROS domains of this machine are in use by tests and benchmarks")

    def close(self) -> None:
        os.close(self._lock)

    def _reserved(self, file: Path) -> bool:
        self._lock = os.open(file, os.O_RDWR | os.O_CREAT)
        if not lock(self._lock):
            self.close()
            return False
        return True
