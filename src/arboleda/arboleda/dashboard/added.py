"""Parts that packages add to the page of one plant; a piece that breaks is left out of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator
from dataclasses import replace
from functools import partial
from importlib.metadata import EntryPoint
from typing import NamedTuple

from fastapi import FastAPI

from arboleda.host.packages import package_of, registered
from arboleda.host.pieces import Piece, Pieces, piece_of
from arboleda.model.errors import ArboledaError
from arboleda.model.verbs import Verb
from arboleda.web.access.auth import SUBMIT, Role
from arboleda.web.package_routes import addresses, guarded

from .asset_files import Assets
from .body import Parts
from .desk import DOWNLOAD
from .faces import Face
from .faces.moment import Moment
from .page_api import Layout, PageApi
from .page_part import GROUP, Act, OtherRecord, PagePart, Place, Section, Spot
from .wording import Words

SECTION, ACT, RECORD = "section", "act", "record"
TAKEN = "another {kind} has this name"


def installed() -> set[str]:
    """The packages that add to the page."""
    return {package_of(each) for each in registered(GROUP)}


class LeftOut(Exception):
    """A section broke while it was drawn, and is left out now: the page is drawn anew."""


class _Added(NamedTuple):
    point: EntryPoint
    part: PagePart


class AddedParts:
    """AddedParts: the page parts of all packages, in the order of their names. `own` are the runner's."""

    def __init__(self, pieces: Pieces | None = None, own: Collection[str] = ()) -> None:
        self._pieces = pieces or Pieces()
        acts = (SUBMIT, DOWNLOAD, *(each.value for each in Verb))
        self._taken = {(SECTION, each) for each in own} | {(ACT, each) for each in acts}
        self._parts: list[_Added] = []
        for point in self._pieces.registered(GROUP):
            with self._pieces.calling(piece_of(point, "the part of the page")):
                part = point.load()
                if not isinstance(part, PagePart):
                    raise TypeError(f"{point.value} is no PagePart")
                _ = part.assets and part.assets.address  # its files are read
                self._parts.append(_Added(point, self._free(point, part)))

    def _free(self, point: EntryPoint, part: PagePart) -> PagePart:
        """The part without what has a name that is taken."""
        sections = (
            each
            for each in part.sections
            if each.place is not Place.TAB or self._is_free(point, SECTION, each.name)
        )
        return replace(
            part,
            sections=tuple(sections),
            acts={word: act for word, act in part.acts.items() if self._is_free(point, ACT, word)},
            records={name: each for name, each in part.records.items() if self._is_free(point, RECORD, name)},
        )

    def _is_free(self, point: EntryPoint, kind: str, name: str) -> bool:
        if (kind, name) in self._taken:
            taken = ArboledaError(TAKEN.format(kind=kind))
            self._pieces.leave_out(piece_of(point, f"the {kind} {name}"), taken)
            return False
        self._taken.add((kind, name))
        return True

    @property
    def left_out(self) -> int:
        """The number of pieces that are left out by now; with each the page is another one."""
        return len(self._pieces.notes)

    @property
    def assets(self) -> list[Assets]:
        return [part.assets for _, part in self._parts if part.assets is not None]

    @property
    def acts(self) -> dict[str, Act]:
        """The acts by their words."""
        return {word: act for _, part in self._parts for word, act in part.acts.items()}

    @property
    def records(self) -> dict[str, OtherRecord]:
        """The records by their names in the page's address."""
        return {name: each for _, part in self._parts for name, each in part.records.items()}

    def serve(self, server: FastAPI, plant: PageApi) -> None:
        """Add the addresses of packages to the server."""
        taken = addresses(server.router.routes)
        for point, part in self._parts:
            with self._pieces.calling(piece_of(point, "the addresses of the page")):
                if part.serve is not None:
                    beside = FastAPI(openapi_url=None)
                    part.serve(beside, plant)
                    server.router.routes += guarded(beside.router.routes, point, taken, self._pieces)

    def face(self, moment: Moment) -> Face:
        """The changes over time in the sections of packages."""
        found: Face = {}
        for point, part in self._parts:
            piece = piece_of(point, "the face of the page")
            if part.face is not None and piece in self._pieces:
                with self._pieces.sparing(piece):
                    found |= part.face(moment)
        return found

    def drawing(self, plant: PageApi, layout: Layout, words: Words, role: str | None) -> Drawing:
        """The sections for somebody of this role; None is who needs none."""
        seen = [
            each
            for each in self._sections()
            if role in (None, Role.OPERATOR.value) or not each[1].for_operators
        ]
        return Drawing(seen, Spot(plant=plant, layout=layout, words=words), self._pieces)

    def _sections(self) -> Iterator[tuple[Piece, Section]]:
        """The sections that are not left out, each as a piece; several in one place are numbered."""
        count = Counter[Piece]()
        for point, part in self._parts:
            for section in part.sections:
                piece = piece_of(point, f"the section {section.name or section.place.name.lower()}")
                count[piece] += 1
                if count[piece] > 1:
                    piece = replace(piece, what=f"{piece.what} {count[piece]}")
                if piece in self._pieces:
                    yield piece, section


class Drawing:
    """Drawing of the sections of packages, each as a piece, on one page; what breaks raises LeftOut."""

    def __init__(self, sections: list[tuple[Piece, Section]], spot: Spot, pieces: Pieces) -> None:
        self._sections = sections
        self._spot = spot
        self._pieces = pieces

    @property
    def parts(self) -> Parts:
        """The sections that are parts of their own, by their names."""
        own = [each for each in self._sections if each[1].place is Place.TAB]
        return {each[1].name: partial(self._draw_part, *each) for each in own}

    @property
    def within(self) -> dict[str, str]:
        """The places of those that share one with others, by their names."""
        return {section.name: section.within for _, section in self._sections if section.within}

    def put(self, place: Place, cell: str = "") -> None:
        """Draw the sections of a place."""
        for piece, section in self._sections:
            if section.place is place:
                self._draw(piece, section, replace(self._spot, cell=cell))

    def _draw_part(self, piece: Piece, section: Section, _layout: Layout, _words: Words) -> None:
        self._draw(piece, section, self._spot)

    def _draw(self, piece: Piece, section: Section, spot: Spot) -> None:
        with self._pieces.calling(piece):
            section.build(spot)
        if piece not in self._pieces:
            raise LeftOut
