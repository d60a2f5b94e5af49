"""The page of a package, and the part of the plant's page that is made of it."""

from __future__ import annotations

import sys
from asyncio import Semaphore
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import partial
from importlib.metadata import EntryPoint
from typing import Any

from fastapi.concurrency import run_in_threadpool

from arboleda.host.packages import package_of
from arboleda.host.pieces import Pieces, piece_of
from arboleda.model.errors import ArboledaError
from arboleda.model.sentence import Phrase, Sentence
from arboleda.web.access.auth import Role
from arboleda.web.access.needs import RANKS

from ..asset_files import Assets
from ..faces import Face
from ..faces.moment import Moment
from ..page_part import PageAct, PagePart, Place, Request, Section, Spot
from ..tags import tag
from ..wording import Words
from .acts import Act, Asked
from .checks import Spared, right
from .here import Here, shown_by
from .items import Item, Page, Rows, Tab

AT_ONCE = 4  # acts of a page in threads; the others wait, so that one that hangs takes no more of them
NO_FILE = "there is no such file in {folder}"


def page_part(point: EntryPoint, pieces: Pieces) -> PagePart:
    """The part of the plant's page that a package registers; TypeError where it is none."""
    part = point.load()
    if isinstance(part, Page):
        return _declared(part, point, pieces)
    if not isinstance(part, PagePart):
        raise TypeError(f"{point.value} is no Page and no PagePart")
    return part


def _declared(page: Page, point: EntryPoint, pieces: Pieces) -> PagePart:
    """The part that a `Page` declares, without what is wrong in it."""
    package, turn = package_of(point), Semaphore(AT_ONCE)

    def spared(what: str) -> AbstractContextManager[None]:
        return pieces.calling(piece_of(point, what))

    page = right(page, spared)
    return PagePart(
        assets=_assets(page, point.module, spared),
        sections=(
            *(each for tab in page.tabs for each in _tab(tab, page.tabs[0].name, package)),
            *(_section(item, Place.CARD, package) for item in page.card),
            *(_section(item, Place.SETTINGS, package) for item in page.settings),
        ),
        acts={each.word(package): _act(each, turn) for each in _acts(page)},
        face=partial(_shown, package) if page.script else None,
    )


def _assets(page: Page, module: str, spared: Spared) -> Assets | None:
    """The files of a page, without those that are not there."""
    there = []
    assets = Assets(package=sys.modules[module].__package__ or module)
    for each in filter(None, (page.script, *page.styles)):
        with spared(f"the file {each} of the page"):
            if not (assets.folder / each).is_file():
                raise ArboledaError(NO_FILE.format(folder=assets.folder))
            there.append(each)
    styles = tuple(each for each in page.styles if each in there)
    return replace(assets, script=page.script * (page.script in there), styles=styles) if there else None


def _tab(tab: Tab, first: str, package: str) -> Iterator[Section]:
    within = "" if tab.name == first else first
    role = min((item.role for item in tab.items), key=RANKS.index, default=Role.VIEWER)
    yield Section(place=Place.TAB, build=_nothing, name=tab.name, within=within, role=role, label=tab.label)
    for item in tab.items:
        yield _section(item, Place.INSIDE, package, within=tab.name)


def _nothing(_: Spot) -> None:
    """Draw nothing: the items of a tab are sections inside it."""


def _section(item: Item, place: Place, package: str, within: str = "") -> Section:
    return Section(
        place=place,
        build=partial(_draw, item, package, boxed=place is not Place.CARD),
        name=f"{package}.{item.name}",
        within=within,
        role=item.role,
        act=item.word(package),
        face=partial(_face, item, package, by_cell=place is Place.CARD),
    )


def _draw(item: Item, package: str, spot: Spot, *, boxed: bool) -> None:
    with tag("div", classes="box" if boxed else "brought"):
        item.draw(Here(package=package, words=spot.words, cell=spot.cell))


def _face(item: Item, package: str, moment: Moment, *, by_cell: bool) -> Face:
    cells = [cell["name"] for cell in moment.snapshot["cells"]] if by_cell else [""]
    found: Face = {}
    shown = shown_by(package, moment.links)
    for cell in cells:
        found |= item.face(Here(package=package, words=moment.words, cell=cell, shown=shown))
    return found


def _shown(package: str, moment: Moment) -> Face:
    """All that the part shows, for the script."""
    told = shown_by(package, moment.links)
    return {f"shown/{package}/{key}": _plain(moment.words, value) for key, value in told.items()}


def _plain(words: Words, value: object) -> Any:
    """Plain data for JSON, with sentences as their texts; TypeError for anything else."""
    if isinstance(value, Mapping):
        return {str(key): _plain(words, each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(words, each) for each in value]
    if isinstance(value, Sentence | Phrase):
        return words.say(value)
    if value is None or isinstance(value, str | bool | int | float):
        return value
    raise TypeError(f"{type(value).__name__} is no plain data")


def _acts(page: Page) -> list[Act]:
    """All acts of a page, each once; ValueError where two have one name."""
    items = [*(item for tab in page.tabs for item in tab.items), *page.card, *page.settings]
    in_rows = (act for each in items if isinstance(each, Rows) for act in each.acts)
    found: dict[str, Act] = {}
    for act in (*page.acts, *(each for each in items if isinstance(each, Act)), *in_rows):
        if found.setdefault(act.name, act) != act:
            raise ValueError(f"two acts of the page are called {act.name}")
    return [*found.values()]


def _act(act: Act, turn: Semaphore) -> PageAct:
    return PageAct(name=act.label, take=partial(_take, act, turn), role=act.role, asks=act.asks)


async def _take(act: Act, turn: Semaphore, request: Request) -> None:
    """Have somebody's act done in a thread, and say what came of it."""
    words = request.words
    try:
        values = act.read(request.more)
        asked = Asked(values=values, of=request.of, role=request.role, plant=request.plant)
        async with turn:
            outcome = await run_in_threadpool(act.take, asked)
    except ArboledaError as error:
        request.say(words.say(error.sentence), good=False)
    else:
        done = words("page.act_done", act=words.say(act.label))
        request.say(done if outcome is None else words.say(outcome), good=True)
