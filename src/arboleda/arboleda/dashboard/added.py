"""Parts that packages add to the page of one plant; a piece that breaks is left out of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator
from dataclasses import replace
from functools import partial
from importlib.metadata import EntryPoint
from typing import NamedTuple

from fastapi import FastAPI
from fastapi import Request as HttpRequest

from arboleda.host.packages import package_of, registered
from arboleda.host.pieces import RUNNER, THE_PAGE, Piece, Pieces, piece_of
from arboleda.model.errors import ArboledaError
from arboleda.model.packages import PROOFS
from arboleda.model.verbs import Verb
from arboleda.web.access.auth import SUBMIT
from arboleda.web.missing import missing
from arboleda.web.package_routes import addresses, guarded

from .added_sections import Drawing, Placed
from .asset_files import Assets
from .desk import DOWNLOAD
from .faces import Face
from .faces.moment import Moment
from .package_page.page import page_part
from .page_api import Layout, PageApi
from .page_part import GROUP, PageAct, PagePart, Place, Request, Section, Spot
from .toolkit import Client
from .wording import Words

PAST = "at"  # in the address of a page on a record: the moment
SECTION, ACT, PAGE = "section", "act", "page"


def installed() -> set[str]:
    """The packages that add to the page."""
    return {package_of(each) for each in registered(GROUP)}


class _Added(NamedTuple):
    point: EntryPoint
    part: PagePart


class AddedParts:
    """AddedParts: the page parts of all packages, in the order of their names. `own` are the runner's."""

    def __init__(self, pieces: Pieces | None = None, own: Collection[str] = ()) -> None:
        self._pieces = pieces or Pieces()
        acts = (SUBMIT, DOWNLOAD, *(each.value for each in Verb))
        runners = (*((SECTION, each) for each in own), *((ACT, each) for each in acts))
        self._taken = dict.fromkeys(runners, RUNNER)
        self._parts: list[_Added] = []
        for point in self._pieces.registered(GROUP):
            with self._pieces.calling(piece_of(point, THE_PAGE)):
                part = page_part(point, self._pieces)
                _ = part.assets and part.assets.address  # its files are read
                self._parts.append(_Added(point, self._free(point, part)))
        self._sections = [*self._placed()]

    def _free(self, point: EntryPoint, part: PagePart) -> PagePart:
        """The part without what has a name that is taken."""
        tabs = {each.name for each in part.sections if each.place is Place.TAB}
        taken = {name for name in tabs if not self._is_free(point, SECTION, name)}
        return replace(
            part,
            sections=tuple(each for each in part.sections if _tab_of(each) not in taken),
            acts={word: act for word, act in part.acts.items() if self._is_free(point, ACT, word)},
            pages={key: each for key, each in part.pages.items() if self._is_free(point, PAGE, key)},
        )

    def _is_free(self, point: EntryPoint, kind: str, name: str) -> bool:
        if whose := self._taken.get((kind, name)):
            self._pieces.leave_out_taken(piece_of(point, f"the {kind} {name}"), whose)
            return False
        self._taken[kind, name] = package_of(point)
        return True

    @property
    def left_out(self) -> int:
        """The number of pieces that are left out by now; with each the page is another one."""
        return len(self._pieces.notes)

    @property
    def assets(self) -> list[Assets]:
        return [part.assets for _, part in self._parts if part.assets is not None]

    @property
    def acts(self) -> dict[str, PageAct]:
        """The acts by their words."""
        return {
            word: replace(act, take=partial(self._take, piece_of(point, f"the act {word}"), act))
            for point, part in self._parts
            for word, act in part.acts.items()
        }

    async def _take(self, piece: Piece, act: PageAct, request: Request) -> None:
        """Have a package do its act; one that breaks is left out, also where it was shown before."""
        if piece in self._pieces:
            with self._pieces.sparing(piece):
                await act.take(request)
        if piece not in self._pieces:
            name = request.words.say(act.name)
            broke = request.words("page.act_broke", act=request.words.flat.get(name, name))
            request.say(broke, good=False)

    def asks(self, words: Words) -> dict[str, str]:
        """The questions before acts, by their words."""
        return {word: words.say(act.asks) for word, act in self.acts.items() if act.asks}

    @property
    def pages(self) -> dict[str, Piece]:
        """The pages in place of the plant's, by their keys in its address."""
        found = {key: piece_of(point, f"the page {key}") for point, part in self._parts for key in part.pages}
        return {key: piece for key, piece in found.items() if piece in self._pieces}

    def page(self, request: HttpRequest, client: Client, plant: PageApi) -> str | None:
        """The HTML of the page for which this address asks; None for that of the plant."""
        if PAST in request.query_params and PROOFS not in installed():
            raise missing(PROOFS)
        for key, piece in self.pages.items():
            if key in request.query_params:
                build = next(part.pages[key] for _, part in self._parts if key in part.pages)
                refused = None
                with self._pieces.calling(piece):
                    try:
                        return build(request, client, plant)
                    except ArboledaError as error:  # what it has to show is not there: it does not break
                        refused = error
                if refused is not None:
                    raise refused
        return None

    def serve(self, server: FastAPI, plant: PageApi) -> None:
        """Add the addresses of packages to the server."""
        taken = dict.fromkeys(addresses(server.router.routes), RUNNER)
        for point, part in self._parts:
            mine = piece_of(point, "the addresses of the page")
            with self._pieces.calling(mine):
                if part.serve is not None:
                    beside = FastAPI(openapi_url=None)
                    part.serve(beside, plant)
                    server.router.routes += guarded(beside.router.routes, point, taken, self._pieces, mine)

    def face(self, moment: Moment) -> Face:
        """The changes over time in the sections of packages."""
        found: Face = {}
        for piece, face in self._faces():
            with self._pieces.sparing(piece):
                found |= face(moment)
        return found

    def _faces(self) -> Iterator[tuple[Piece, Callable[[Moment], Face]]]:
        """The faces of all sections, each as a piece that is not left out."""
        for point, part in self._parts:
            piece = piece_of(point, "the face of the page")
            if part.face is not None and piece in self._pieces:
                yield piece, part.face
        for each in self._sections:
            if each.section.face is not None and each.is_in(self._pieces):
                yield each.piece, each.section.face

    def drawing(self, plant: PageApi, layout: Layout, words: Words, role: str | None) -> Drawing:
        """The sections for somebody of this role; None is who needs none."""
        sections = [each for each in self._sections if each.is_in(self._pieces) and each.is_for(role)]
        return Drawing(sections, Spot(plant=plant, layout=layout, words=words), self._pieces)

    def _placed(self) -> Iterator[Placed]:
        """The sections, each as a piece; several in one place are numbered."""
        count = Counter[Piece]()
        for point, part in self._parts:
            for section in part.sections:
                piece = piece_of(point, f"the section {section.name or section.place.name.lower()}")
                count[piece] += 1
                if count[piece] > 1:
                    piece = replace(piece, what=f"{piece.what} {count[piece]}")
                act = piece_of(point, f"the act {section.act}") if section.act else piece
                yield Placed(package_of(point), piece, act, section)


def _tab_of(section: Section) -> str:
    """The name of the part of its own that a section is, or is inside; "" for one that stands elsewhere."""
    return {Place.TAB: section.name, Place.INSIDE: section.within}.get(section.place, "")
