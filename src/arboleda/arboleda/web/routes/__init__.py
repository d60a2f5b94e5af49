"""Routes that look at the plant, a module each: a path, what it takes and gives, what it asks for.

The runner's own are in OWN. A package registers a function under the entry point group `arboleda.routes`,
under its own name or as PACKAGE.WHAT where it has several; it makes an APIRouter of a `PlantApi`, which it
asks for what the package's parts offer. `access.needs` has who may ask for its routes.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from importlib import import_module

from fastapi import APIRouter

from arboleda.host.packages import package_of, registered

from ..package_routes import guarded
from ..plant_api import PlantApi

LOG = logging.getLogger(__name__)
GROUP = "arboleda.routes"
OWN = ("assistants", "promises", "recipes")
LeaveOut = Callable[[str, BaseException], None]  # told of a package that breaks


def routers(side: PlantApi, leave_out: LeaveOut | None = None) -> list[APIRouter]:
    """The routers of the runner, and of packages after them: no package takes a path of the runner's."""
    own = [import_module(f"{__name__}.{name}").routes(side) for name in OWN]
    return [*own, *_packaged(side, leave_out or _log)]


def installed() -> set[str]:
    """The packages that bring routes."""
    return {package_of(each) for each in registered(GROUP)}


def _packaged(side: PlantApi, leave_out: LeaveOut) -> Iterator[APIRouter]:
    for point in registered(GROUP):
        try:
            router = point.load()(side)
            if not isinstance(router, APIRouter):
                raise TypeError(f"{point.value} makes no APIRouter")
        except (Exception, SystemExit) as error:  # noqa: BLE001 - whatever a package does, the plant is served
            leave_out(package_of(point), error)
            continue
        beside = APIRouter()
        beside.routes += guarded(router.routes, package_of(point))
        yield beside


def _log(package: str, error: BaseException) -> None:
    LOG.error("the routes of the package %s are left out: %r", package, error)
