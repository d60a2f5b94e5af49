"""The twin at moments of a record: each is drawn from what was known at that moment alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..twin.twin import Twin

if TYPE_CHECKING:  # without a record, the libraries that read one are not needed
    from .past import Past


class Stills:
    """Stills: draws the twin at each moment, once somebody has wanted to see it and it was opened."""

    def __init__(self) -> None:
        self._twin: Twin | None = None

    @property
    def ready(self) -> bool:
        return self._twin is not None

    def open(self, twin: Twin) -> None:
        """Take the twin that is drawn from now on; from any thread."""
        self._twin = twin

    def at(self, past: Past, moment: int) -> dict[str, Any]:
        """The drawing of a moment; empty before a twin was opened."""
        return {} if self._twin is None else self._twin.still(past.positions(moment))
