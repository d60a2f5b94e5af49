"""The page of a package, and the part of the plant's page that is made of it."""

from __future__ import annotations

import sys
from asyncio import Semaphore
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from fastapi.concurrency import run_in_threadpool

from arboleda.model.errors import ArboledaError
from arboleda.model.sentence import Phrase, Sentence
from arboleda.web.access.needs import RANKS

from ..asset_files import Assets
from ..faces import Face
from ..faces.moment import Moment
from ..page_part import PageAct, PagePart, Place, Request, Section, Spot
from ..tags import tag
from ..wording import Text, Words
from .acts import Act, Asked
from .here import Here, Item, shown_by
from .items import Rows

AT_ONCE = 4  # acts of a page in threads; the others wait, so that one that hangs takes no more of them


@dataclass(frozen=True)
class Tab:
    """Tab of the header, with its items below each other. `name` stands in the page's address."""

    name: str
    label: Text
    items: Sequence[Item]


@dataclass(frozen=True, kw_only=True)
class Page:
    """Page of a package: tabs, items below the card of each cell, and items among the settings.

    Items are `Value`, `Rows`, `Chart` and `Act`. Several tabs share one place of the header. `script` is a
    module in the folder `assets` beside the module of the page; it exports `start()`. `styles` are names of
    style sheets there. `acts` are asked for by that script alone.
    """

    tabs: Sequence[Tab] = ()
    card: Sequence[Item] = ()
    settings: Sequence[Item] = ()
    acts: Sequence[Act] = ()
    script: str = ""
    styles: Sequence[str] = ()


def part_of(page: Page, package: str, module: str) -> PagePart:
    """The part of the plant's page that a package declares in this module."""
    turn = Semaphore(AT_ONCE)
    return PagePart(
        assets=_assets(page, module),
        sections=(
            *(each for tab in page.tabs for each in _tab(tab, page.tabs[0].name, package)),
            *(_section(item, Place.CARD, package) for item in page.card),
            *(_section(item, Place.SETTINGS, package) for item in page.settings),
        ),
        acts={each.word(package): _act(each, turn) for each in _acts(page)},
        face=partial(_shown, package) if page.script else None,
    )


def _assets(page: Page, module: str) -> Assets | None:
    if not page.script and not page.styles:
        return None
    package = sys.modules[module].__package__ or module
    return Assets(package=package, script=page.script, styles=tuple(page.styles))


def _tab(tab: Tab, first: str, package: str) -> Iterator[Section]:
    within = "" if tab.name == first else first
    role = min((item.role for item in tab.items), key=RANKS.index)
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
        if found.setdefault(act.name, act) is not act:
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
