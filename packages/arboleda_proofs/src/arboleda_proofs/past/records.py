"""The records that a page can show: its own, and others of the same plant."""

from __future__ import annotations

import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from pathlib import Path
from typing import Any

from arboleda.extension import Phrase
from arboleda.recorder import files, reader
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.preamble import Beginning
from arboleda_proofs.playback.views import Views

from .past import Past
from .side import Start

FRESH_S = 5.0  # between two looks at the end of a record
OPEN = 3  # records that are kept open, beside one another
SHOWN = 50  # starts to choose from, the last ones
NO_START = Phrase(
    "record.no_start",
    "There is no record of this start, or it had another plant file: see `arboleda record list`, then "
    "`arboleda record replay FILE --page`.",
)


class Records:
    """PastSide of a plant with this `layout`. `own` is a file of the record that is shown where none is
    chosen, NoRecord says why there is none.

    Other records can be chosen if their plant file, and all that it uses, is the same: the page and its twin
    are made of it. For any thread; the caller waits for the disk.
    """

    def __init__(
        self, own: Callable[[], Path], layout: Callable[[], dict[str, Any]], urdf: Callable[[str], str]
    ) -> None:
        self._own = own
        self._layout = layout
        self._urdf = urdf
        self._open: OrderedDict[int | None, tuple[float, Past]] = OrderedDict()
        self._beginnings: dict[int, tuple[Beginning, int] | None] = {}
        self._one = threading.Lock()

    def layout(self) -> dict[str, Any]:
        return self._layout()

    def urdf(self, robot: str) -> str:
        return self._urdf(robot)

    def past(self, epoch: int | None = None) -> Past:
        """The record of a start, as far as it is written; for None the page's own."""
        with self._one:
            opened = self._open.get(epoch)
            if opened is None:
                opened = time.monotonic(), Past(Views(reader.opened(self._file(epoch))), self._layout())
            elif time.monotonic() - opened[0] > FRESH_S:
                opened[1].grow()
                opened = time.monotonic(), opened[1]
            self._open[epoch] = opened
            self._open.move_to_end(epoch)
            while len(self._open) > OPEN:
                self._open.popitem(last=False)
            return opened[1]

    def starts(self) -> list[Start]:
        """The starts of the plant that have a record beside the page's own, the last first."""
        with self._one:
            own = self._own()
            mine = files.part_at(own)
            if mine is None:  # a copy somewhere else: what is beside it need not be of this plant
                return []
            epochs = sorted({part.epoch for part in files.parts_in(own.parent)}, reverse=True)[:SHOWN]
            return [start for epoch in epochs if (start := self._start(own, epoch)) is not None]

    def _start(self, own: Path, epoch: int) -> Start | None:
        beginning = self._beginning(own.parent, epoch)
        if beginning is None:
            return None
        mine = files.part_at(own)
        is_own = mine is not None and epoch == mine.epoch
        return Start(
            epoch=epoch, began=beginning[1] // 1_000_000, is_own=is_own, is_same=self._is_same(own, epoch)
        )

    def _is_same(self, own: Path, epoch: int) -> bool:
        mine = files.part_at(own)
        ours = self._beginning(own.parent, mine.epoch) if mine is not None else None
        other = self._beginning(own.parent, epoch)
        return None not in (ours, other) and _plant(ours[0]) == _plant(other[0])  # type: ignore[index]

    def _beginning(self, folder: Path, epoch: int) -> tuple[Beginning, int] | None:
        """The beginning of a start with its time; None if it cannot be read."""
        if epoch not in self._beginnings:
            first = next((part for part in files.parts_in(folder) if part.epoch == epoch), None)
            try:
                read = reader.alone(first.path).first if first is not None else None
            except NoRecord:
                read = None  # perhaps it is not written yet
            if read is None:
                return None
            self._beginnings[epoch] = read.beginning, read.began_ns
        return self._beginnings[epoch]

    def _file(self, epoch: int | None) -> Path:
        own = self._own()
        if epoch is None:
            return own
        mine = files.part_at(own)
        paths = [part.path for part in files.parts_in(own.parent) if part.epoch == epoch]
        if mine is None or not paths or not self._is_same(own, epoch):
            raise NoRecord(NO_START())
        return paths[-1]


def _plant(beginning: Beginning) -> tuple[Any, ...]:
    """The parts of a beginning that determine the page: two that are equal in them can share one."""
    read = beginning.files
    return read.plant, dict(read.contents), beginning.virtual, beginning.simulated, beginning.rate
