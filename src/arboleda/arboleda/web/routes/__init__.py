"""Routes that look at the plant, a module each: a path, what it takes and gives, what it asks for.

The runner's own are in OWN. A package registers a function under the entry point group `arboleda.routes`,
under its own name or as PACKAGE.WHAT where it has several; it makes an APIRouter of a `PlantApi`, which it
asks for what the package's parts offer. `access.needs` has who may ask for its routes.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

from fastapi import APIRouter

from arboleda.host.packages import package_of, registered
from arboleda.host.pieces import Pieces, piece_of

from ..package_routes import addresses, guarded
from ..part_routes import PartRoutes
from ..plant_api import PlantApi

GROUP = "arboleda.routes"
OWN = ("assistants", "promises", "recipes")


def routers(side: PlantApi) -> list[APIRouter]:
    """The routers of the runner's own modules here."""
    return [import_module(f"{__name__}.{name}").routes(side) for name in OWN]


def installed() -> set[str]:
    """The packages that bring routes."""
    return {package_of(each) for each in registered(GROUP)}


def packaged(side: PlantApi, before: Sequence[APIRouter], pieces: Pieces) -> list[APIRouter]:
    """The routers of packages, without a route that `before`, the page or another package has."""
    taken = {each for router in before for each in addresses(router.routes)}
    found: list[APIRouter] = []
    makers = [(point, lambda point=point: point.load()(side)) for point in pieces.registered(GROUP)]
    for point, make in (*makers, *(side.ask(PartRoutes) or ())):
        with pieces.calling(piece_of(point, "the routes")):
            router = make()
            if not isinstance(router, APIRouter):
                raise TypeError(f"{point.value} makes no APIRouter")
            found.append(APIRouter())
            found[-1].routes += guarded(router.routes, point, taken, pieces)
    return found
