"""Records beside those of a plant's starts, as packages have them."""

from __future__ import annotations

from collections.abc import Callable

from .side import PastSide
from .stills import Stills


class LastOther:
    """LastOther: such a record as it is now, with the drawings of its twin."""

    def __init__(self, find: Callable[[], PastSide]) -> None:
        self._find = find
        self._known: tuple[PastSide, Stills] | None = None

    def last(self) -> tuple[PastSide, Stills]:
        """The record and its drawings; an ArboledaError says that there is none."""
        side = self._find()
        if self._known is None or self._known[0] is not side:
            self._known = side, Stills()
        return self._known
