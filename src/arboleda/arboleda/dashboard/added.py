"""Parts that packages add to the page of one plant; a package that breaks is left out of it."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from fastapi import FastAPI

from arboleda.host.packages import package_of, registered
from arboleda.web.access.auth import Role
from arboleda.web.package_routes import guarded

from .asset_files import Assets
from .body import Parts
from .faces import Face
from .faces.moment import Moment
from .page_api import Layout, PageApi
from .page_part import GROUP, Act, OtherRecord, PagePart, Place, Section, Spot
from .wording import Words

LOG = logging.getLogger(__name__)
LeaveOut = Callable[[str, BaseException], None]  # told of a package that breaks


def installed() -> set[str]:
    """The packages that add to the page."""
    return {package_of(each) for each in registered(GROUP)}


class LeftOut(Exception):
    """A package broke while it drew, and is left out now: the page is drawn anew."""


class _Added(NamedTuple):
    package: str
    part: PagePart


class AddedParts:
    """AddedParts: the page parts of all packages, in the order of their names."""

    def __init__(self, leave_out: LeaveOut | None = None) -> None:
        self._tell = leave_out or _log
        self._parts: list[_Added] = []
        self._left_out: set[str] = set()
        for point in registered(GROUP):
            if package_of(point) in self._left_out:
                continue
            try:
                part = point.load()
                if not isinstance(part, PagePart):
                    raise TypeError(f"{point.value} is no PagePart")
                _ = part.assets and part.assets.address  # its files are read
            except (Exception, SystemExit) as error:  # noqa: BLE001 - whatever a package does, the page is shown
                self._leave_out(package_of(point), error)
                continue
            self._parts.append(_Added(package_of(point), part))

    @property
    def packages(self) -> list[str]:
        return [package for package, _ in self._parts]

    @property
    def assets(self) -> list[Assets]:
        return [part.assets for _, part in self._parts if part.assets is not None]

    @property
    def acts(self) -> dict[str, Act]:
        """The acts by their words; of two alike the first."""
        return {word: act for _, part in reversed(self._parts) for word, act in part.acts.items()}

    @property
    def records(self) -> dict[str, OtherRecord]:
        """The records by their names in the page's address; of two alike the first."""
        return {name: each for _, part in reversed(self._parts) for name, each in part.records.items()}

    def serve(self, server: FastAPI, plant: PageApi) -> None:
        """Add the addresses of packages to the server."""
        for package, part in [*self._parts]:
            try:
                if part.serve is not None:
                    beside = FastAPI(openapi_url=None)
                    part.serve(beside, plant)
                    server.router.routes += guarded(beside.router.routes, package)
            except Exception as error:  # noqa: BLE001 - whatever a package does, the page is shown
                self._leave_out(package, error)

    def face(self, moment: Moment) -> Face:
        """The changes over time in the sections of packages."""
        found: Face = {}
        for package, part in [*self._parts]:
            try:
                found |= {} if part.face is None else part.face(moment)
            except Exception as error:  # noqa: BLE001 - whatever a package does, the page goes on
                self._leave_out(package, error)
        return found

    def drawing(self, plant: PageApi, layout: Layout, words: Words, role: str | None) -> Drawing:
        """The sections for somebody of this role; None is who needs none."""
        found = [(package, section) for package, part in self._parts for section in part.sections]
        seen = [each for each in found if role in (None, Role.OPERATOR.value) or not each[1].for_operators]
        return Drawing(seen, Spot(plant=plant, layout=layout, words=words), self._leave_out)

    def _leave_out(self, package: str, error: BaseException) -> None:
        self._left_out.add(package)
        self._parts = [each for each in self._parts if each.package != package]
        self._tell(package, error)


class Drawing:
    """Drawing of the sections of packages, each with its package, on one page; what breaks raises LeftOut."""

    def __init__(self, sections: list[tuple[str, Section]], spot: Spot, leave_out: LeaveOut) -> None:
        self._sections = sections
        self._spot = spot
        self._leave_out = leave_out

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
        for package, section in self._sections:
            if section.place is place:
                self._draw(package, section, replace(self._spot, cell=cell))

    def _draw_part(self, package: str, section: Section, _layout: Layout, _words: Words) -> None:
        self._draw(package, section, self._spot)

    def _draw(self, package: str, section: Section, spot: Spot) -> None:
        try:
            section.build(spot)
        except Exception as error:
            self._leave_out(package, error)
            raise LeftOut from error


def _log(package: str, error: BaseException) -> None:
    LOG.error("the package %s is left out of the page: %r", package, error)
