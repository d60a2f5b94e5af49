"""OeeApi of the plant in this process: figures of what its memory keeps."""

from __future__ import annotations

import time
from collections.abc import Sequence

from arboleda.oee.figures import Oee
from arboleda.store.task_rows import History

from .api import OeeApi, OeeQuery
from .rows import figures


class OeeDesk(OeeApi):
    """OeeDesk: for threads of a server, which wait for the disk."""

    def __init__(self, history: History, cells: Sequence[str]) -> None:
        self._history = history
        self._cells = cells

    def oee(self, query: OeeQuery) -> list[Oee]:
        return figures(self._history, query, time.time(), self._cells)
