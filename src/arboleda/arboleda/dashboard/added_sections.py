"""Drawing of the sections of packages on one page; one that breaks is left out, and the page drawn anew."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from arboleda.host.pieces import Piece, Pieces
from arboleda.web.access.auth import Role
from arboleda.web.access.needs import reaches

from .body import Parts
from .page_api import Layout
from .page_part import Place, Section, Spot
from .wording import Words


class LeftOut(Exception):
    """A section broke while it was drawn, and is left out now: the page is drawn anew."""


class Placed(NamedTuple):
    """A section of a package, as a piece, with that of the act without which it is left out."""

    package: str
    piece: Piece
    act: Piece
    section: Section

    def is_in(self, pieces: Pieces) -> bool:
        return self.piece in pieces and self.act in pieces

    def is_for(self, role: str | None) -> bool:
        """True if somebody of this role sees it; None is who needs none."""
        return role is None or reaches(Role(role), self.section.role)


class Drawing:
    """Drawing of the sections of packages, each as a piece, on one page; what breaks raises LeftOut."""

    def __init__(self, sections: Sequence[Placed], spot: Spot, pieces: Pieces) -> None:
        self._sections = sections
        self._spot = spot
        self._pieces = pieces

    @property
    def parts(self) -> Parts:
        """The sections that are parts of their own, by their names."""
        return {each.section.name: partial(self._draw_part, each) for each in self._of(Place.TAB)}

    @property
    def within(self) -> dict[str, str]:
        """The places of those that share one with others, by their names."""
        tabs = (each.section for each in self._of(Place.TAB))
        return {section.name: section.within for section in tabs if section.within}

    @property
    def labels(self) -> dict[str, str]:
        """The words of tabs that have some of their own."""
        tabs = (each.section for each in self._of(Place.TAB))
        return {f"tab.{each.name}": self._spot.words.say(each.label) for each in tabs if each.label}

    def put(self, place: Place, cell: str = "") -> None:
        """Draw the sections of a place."""
        for each in self._of(place):
            self._draw(each, replace(self._spot, cell=cell))

    def _of(self, place: Place) -> list[Placed]:
        return [each for each in self._sections if each.section.place is place]

    def _draw_part(self, part: Placed, _layout: Layout, _words: Words) -> None:
        """Draw a part of its own, then what is inside it."""
        self._draw(part, self._spot)
        for each in self._of(Place.INSIDE):
            if (each.package, each.section.within) == (part.package, part.section.name):
                self._draw(each, self._spot)

    def _draw(self, placed: Placed, spot: Spot) -> None:
        with self._pieces.calling(placed.piece):
            placed.section.build(spot)
        if placed.piece not in self._pieces:
            raise LeftOut
