"""Part of the page that a package adds: sections, requests that they make, and what changes in them.

A package registers a `PagePart` under the entry point group `arboleda.page`, under its own name or as
PACKAGE.WHAT where it has several.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, Protocol

from arboleda.web.access.auth import Role

from .asset_files import Assets
from .faces import Face
from .faces.moment import Moment
from .page_api import Layout, PageApi
from .wording import Text, Words

if TYPE_CHECKING:
    from fastapi import FastAPI  # a page without a server needs none
    from fastapi import Request as HttpRequest

    from .toolkit import Client

GROUP = "arboleda.page"


class Place(Enum):
    """Place of a section on the page."""

    TAB = "a part of its own, to which a tab of the header leads, or one within the place of other parts"
    TOP = "below the header, whichever part is shown"
    CARD = "below the card of each cell"
    TREE = "among the tools of the tree of each cell"
    TASK = "in the page of one task"
    TASKS = "between the tasks of this start and those of all starts"
    CELL_MENU = "in the menu of each cell, below the verbs of operators"
    PLANT_MENU = "in the menu of the whole plant, below those"
    SETTINGS = "among the settings"
    INSIDE = "inside a part of its own of the same package"


@dataclass(frozen=True, kw_only=True)
class Spot:
    """Spot at which a section is drawn; `cell` is the one at `CARD` and `TREE`, "" elsewhere."""

    plant: PageApi
    layout: Layout
    words: Words
    cell: str = ""


@dataclass(frozen=True, kw_only=True)
class Section:
    """Section of the page. `build` draws it with `tags`, or nothing where this plant has no use for it.

    `name` is for parts of their own. The tab says `label`, else `tab.<name>`, or the name where it has no
    words; the element is `part-<name>`. `within` is the name of another part, in whose place it stands, or
    inside which it is drawn. `role` is the least that sees it. One that needs an `act` is left out with
    that. `face` is what changes in it over time.
    """

    place: Place
    build: Callable[[Spot], None]
    name: str = ""
    label: Text = ""
    within: str = ""
    role: Role = Role.VIEWER
    act: str = ""
    face: Callable[[Moment], Face] | None = None


class Say(Protocol):
    """Shows an answer on the page; `good` is None while the outcome is unknown."""

    def __call__(self, sentence: str, *, good: bool | None) -> None: ...


@dataclass(frozen=True, kw_only=True)
class Request:
    """Request of one browser, whose role allows it; `more` is whatever the script sent with it."""

    act: str
    of: str
    more: object
    role: Role
    plant: PageApi
    words: Words
    say: Say


@dataclass(frozen=True, kw_only=True)
class PageAct:
    """Request of a page: `take` does it, in the server's event loop.

    `name` is the key of its words, or its text. `role` is the least that may ask for it. The page asks
    `asks` first.
    """

    name: Text
    take: Callable[[Request], Awaitable[None]]
    role: Role = Role.OPERATOR
    asks: Text = ""


@dataclass(frozen=True, kw_only=True)
class PagePart:
    """Part of the page that a package adds.

    The module `assets.script` exports `start()`, and `arrive(there)` where it wants to know to which tab,
    cell and task somebody goes. `acts` are by the words with which a script asks for them. `face` is what
    changes over time. `serve` adds addresses to the server. `pages` are shown in place of the plant's
    where its address has their key; each returns the HTML of its parts, and an ArboledaError says why not.
    """

    assets: Assets | None = None
    sections: tuple[Section, ...] = ()
    acts: Mapping[str, PageAct] = field(default_factory=dict)
    face: Callable[[Moment], Face] | None = None
    serve: Callable[[FastAPI, PageApi], None] | None = None
    pages: Mapping[str, Callable[[HttpRequest, Client, PageApi], str]] = field(default_factory=dict)


class Put(Protocol):
    """Draws the sections that packages have for a place, and a cell if each cell has one."""

    def __call__(self, place: Place, cell: str = "") -> None: ...


def put_nothing(place: Place, cell: str = "") -> None:
    """Put of a page to which packages add nothing."""
