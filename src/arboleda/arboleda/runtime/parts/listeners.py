"""Whoever is told of the plant; none of them can end it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeVar

from arboleda.host.pieces import Piece, registrant

from .plant_log import log_defect

T = TypeVar("T")
LeaveOut = Callable[[Piece, Exception], None]


class Listeners(list[Callable[[T], None]]):
    """Listeners: are told in their order. One that a package has appended is left out once it raises."""

    def __init__(self, leave_out: LeaveOut) -> None:
        super().__init__()
        self._leave_out = leave_out
        self._pieces: dict[int, Piece] = {}  # by the id of a listener

    def append(self, listener: Callable[[T], None]) -> None:
        piece = registrant(f"the listener {named(listener)}")
        if piece is not None:
            self._pieces[id(listener)] = piece
        super().append(listener)

    def tell(self, what: T) -> None:
        for _ in self.telling(what):
            pass

    def telling(self, what: T) -> Iterator[None]:
        """Tell all of them, with a pause after each."""
        for listener in [*self]:
            try:
                listener(what)
            except Exception as error:  # noqa: BLE001 - whatever is told of a plant must not end it
                piece = self._pieces.get(id(listener))
                if piece is None:
                    log_defect("what is told of the plant", error)
                else:
                    self._leave_out(piece, error)
                    self.remove(listener)
            yield


def named(listener: object) -> str:
    """The name of a listener, for people, as `Orders.follow`."""
    return str(getattr(listener, "__qualname__", type(listener).__name__)).rpartition("<locals>.")[2]
