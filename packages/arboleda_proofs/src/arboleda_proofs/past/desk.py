"""Records that the page of a plant shows: those of its starts, and those that packages add."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from arboleda.extension import Phrase
from arboleda.recorder.errors import NoRecord

from .frame_queue import BESIDE_S, FrameQueue

if TYPE_CHECKING:  # the page is made once the plant runs, and its libraries take a while
    from arboleda.extension import PageApi

    from .side import PastSide, Shown

NOT_YET = Phrase("record.not_yet", "There is no record of this start yet; try again in some seconds.")


@dataclass(frozen=True, kw_only=True)
class OtherRecord:
    """Record beside those of the plant's starts. An ArboledaError of `side` says why there is none.

    Operators may look at it; `may` says in English what others may not.
    """

    side: Callable[[], PastSide]
    may: str


class PastDesk:
    """PastDesk: the records of a plant with this state folder, None where it writes none.

    `others` are by their names in the page's address. `turns` are those of all open pages.
    """

    def __init__(self, state: Path | None) -> None:
        self.others: dict[str, OtherRecord] = {}
        self.turns = FrameQueue(BESIDE_S)
        self._state = state
        self._own: Shown | None = None
        self._last: dict[str, Shown] = {}

    def own(self, plant: PageApi) -> Shown:
        """The record of this start, with those of others to choose from."""
        if self._own is None:
            from .records import Records
            from .side import Shown

            self._own = Shown(Records(lambda: self._file(plant), plant.layout, plant.urdf))
        return self._own

    def other(self, name: str) -> Shown:
        """A record beside those of starts, as it is now."""
        from .side import Shown

        side = self.others[name].side()
        if name not in self._last or self._last[name].side is not side:
            self._last[name] = Shown(side)
        return self._last[name]

    def _file(self, plant: PageApi) -> Path:
        """The last file of the record of this start; NoRecord where there is none yet."""
        from arboleda.recorder import files

        epoch = plant.snapshot()["epoch"]
        parts = files.parts_in(self._state / files.FOLDER) if self._state else []
        mine = [part.path for part in parts if part.epoch == epoch]
        if not mine:
            raise NoRecord(NOT_YET())
        return mine[-1]
