"""The plant of a record as the page on it sees it, with the twin that is drawn of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from arboleda.dashboard.twin import window
from arboleda.dashboard.twin.twin import Twin

if TYPE_CHECKING:  # without a record, the libraries that read one are not needed
    from .past import Past


@dataclass(frozen=True, kw_only=True)
class Start:
    """A start of a plant of which there is a record: `began` at that ms of Unix time.

    `is_own`: the page shows it unless another is chosen; `is_same`: it had the same plant file, so that the
    page can show it.
    """

    epoch: int
    began: int
    is_own: bool
    is_same: bool


class PastSide(Protocol):
    """A plant of which there is a record; nothing can be asked of it."""

    def layout(self) -> dict[str, Any]:
        """The plant's `views.view.layout`."""

    def urdf(self, robot: str) -> str:
        """A robot's drawing; an ArboledaError says why there is none. Takes a while."""

    def past(self, epoch: int | None = None) -> Past:
        """The record of the page, or of another start, as of now; it waits for the disk, so do not call it in
        the event loop. An ArboledaError says why there is none."""

    def starts(self) -> list[Start]:
        """The starts to choose from, the last first; it waits for the disk, too."""


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


class Shown:
    """Record that is shown: its plant, and what is drawn of it."""

    def __init__(self, side: PastSide) -> None:
        self.side = side
        self.stills = Stills()
        self.scene = window.Scene(side, self.stills)
