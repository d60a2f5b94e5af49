"""What the page on a record may know of the plant that was recorded."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:  # a page of a plant without a record does without the libraries that read one
    from .past import Past


class PastSide(Protocol):
    """A plant of which there is a record; nothing can be asked of it."""

    def layout(self) -> dict[str, Any]:
        """`views.view.layout` of it."""

    def urdf(self, robot: str) -> str:
        """A robot's drawing; an ArboledaError says why there is none. Takes a while."""

    def past(self) -> Past:
        """Its record as of now; it waits for the disk, so not in the event loop. An ArboledaError says why
        there is none."""
