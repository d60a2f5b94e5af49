"""Whoever is told of the plant; none of them can end it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeVar

T = TypeVar("T")


class Listeners(list[Callable[[T], None]]):
    """Listeners: are told in their order. `gives_up` gets what one raises; True where it is told nothing
    more."""

    def __init__(self, gives_up: Callable[[Exception], bool]) -> None:
        super().__init__()
        self._gives_up = gives_up

    def tell(self, what: T) -> None:
        """Tell all of them."""
        for _ in self.telling(what):
            pass

    def telling(self, what: T) -> Iterator[None]:
        """Tell all of them, with a pause after each."""
        for listener in [*self]:
            try:
                listener(what)
            except Exception as error:  # noqa: BLE001 - whatever is told of a plant must not end it
                if self._gives_up(error):
                    self.remove(listener)
            yield
