"""Routes that look at the plant, a module each: a path, what it takes and gives, what it asks for.

The runner's own are in OWN. A package registers a function under the entry point group `arboleda.routes`,
under its own name or as PACKAGE.WHAT where it has several; it makes an APIRouter of a `PlantApi`, which it
asks for what the package's parts offer. `access.needs` has who may ask for its routes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from importlib import import_module
from importlib.metadata import EntryPoint
from typing import Any

from fastapi import APIRouter
from starlette.routing import BaseRoute

from arboleda.host.packages import package_of, registered
from arboleda.host.pieces import RUNNER, Pieces, piece_of

from ..package_routes import addresses, breadth, guarded
from ..part_routes import PartRoute, PartRoutes
from ..plant_api import PlantApi

GROUP = "arboleda.routes"
ROUTES = "the routes"
OWN = ("assistants", "promises", "recipes")


def routers(side: PlantApi) -> list[APIRouter]:
    """The routers of the runner's own modules here."""
    return [import_module(f"{__name__}.{name}").routes(side) for name in OWN]


def installed() -> set[str]:
    """The packages that bring routes."""
    return {package_of(each) for each in registered(GROUP)}


def packaged(side: PlantApi, before: Sequence[APIRouter], pieces: Pieces) -> list[APIRouter]:
    """The routers of packages, without a route that `before`, the page or another package has. What one asks
    for by its whole address goes before what another one would take with it, as `/api/{anything}`."""
    taken = {each: RUNNER for router in before for each in addresses(router.routes)}
    found: list[BaseRoute] = []
    for each in (*_registered(side, pieces), *(side.ask(PartRoutes) or ())):
        with pieces.calling(piece_of(each.point, ROUTES)):
            router = each.make()
            if not isinstance(router, APIRouter):
                raise TypeError(f"{each.point.value} makes no APIRouter")
            found += guarded(router.routes, each.point, taken, pieces, each.part)
    whole = APIRouter()
    whole.routes += sorted(found, key=breadth)
    return [whole]


def _registered(side: PlantApi, pieces: Pieces) -> Iterator[PartRoute]:
    """The routes that packages register as functions of a plant."""
    for point in pieces.registered(GROUP):
        yield PartRoute(point, piece_of(point, ROUTES), partial(_router, point, side))


def _router(point: EntryPoint, side: PlantApi) -> Any:
    return point.load()(side)
