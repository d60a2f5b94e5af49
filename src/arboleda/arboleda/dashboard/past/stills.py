"""The twin at moments of a record: each is drawn from what was known at that moment alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..twin.twin import Twin

if TYPE_CHECKING:  # a page of a plant without a record does without the libraries that read one
    from .past import Past


class Stills:
    """`open` it with the twin, once somebody wanted to see that; then it has a frame of each moment."""

    def __init__(self) -> None:
        self._twin: Twin | None = None

    @property
    def ready(self) -> bool:
        return self._twin is not None

    def open(self, twin: Twin) -> None:
        """What there is to draw; from any thread."""
        self._twin = twin

    def at(self, past: Past, moment: int) -> dict[str, Any]:
        """What is drawn then; nothing before it was opened."""
        return {} if self._twin is None else self._twin.still(past.positions(moment))
