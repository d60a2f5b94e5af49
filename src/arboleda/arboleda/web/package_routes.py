"""Routes of packages: each is asked only by whom it needs, and is made apart from those of others."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from importlib.metadata import EntryPoint
from typing import Any

from fastapi import routing
from starlette.routing import BaseRoute, Match
from starlette.types import Receive, Scope, Send

from arboleda.host.packages import package_of
from arboleda.host.pieces import Pieces, piece_of
from arboleda.model.errors import ArboledaError

from .access.needs import LOOKED, OPERATORS, Need, declared, method_of
from .request import HISTORY, PAGE, READS, SCENE, TASK, is_stop

NEEDS = "arboleda.needs"  # in the scope of a request for a route of a package, the last one counts
APART = "arboleda.apart"  # in the scope of each request: what runs an application in the loop of a package
STOPS = ("plant", "cells/x", "plants", "plants/x")
KEPT = (
    *(f"GET {each}" for each in (PAGE, TASK, HISTORY, SCENE)),  # of the page, which is asked after all routes
    *(f"POST /api/{each}/stop" for each in STOPS),
)
TAKEN = "another route has this address"


def leaves(routes: Sequence[BaseRoute]) -> tuple[Any, ...]:
    """These routes, with those of included routers in place of their routers."""
    contexts = getattr(routing, "iter_route_contexts", None)  # a FastAPI without it includes them as they are
    return tuple(routes if contexts is None else contexts(routes))


def addresses(routes: Sequence[BaseRoute]) -> set[str]:
    """Methods and paths of these routes, as `POST /api/orders`."""
    return {
        f"{method} {each.path}"
        for each in leaves(routes)
        for method in getattr(each, "methods", None) or ("websocket",)
        if getattr(each, "path", None)
    }


class PackageRoute(BaseRoute):
    """Route of a package, or router that it has included, for those whose role is enough."""

    def __init__(self, route: BaseRoute, package: str) -> None:
        self.behind = route
        self._package = package
        self.methods = getattr(route, "methods", None)
        self._leaves = leaves([route])

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        if is_stop(method_of(scope), scope["path"]):  # made in the server's loop, in which nothing may hang
            return Match.NONE, {}
        match, found = self.behind.matches(scope)
        if match is not Match.FULL:
            return match, found
        return match, {**found, NEEDS: self._needs(scope)}  # what is found changes the scope

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        scope[LOOKED] = scope.pop(NEEDS, (OPERATORS,))
        for need in scope[LOOKED][-1:]:
            need.check(scope)
        apart = scope.get(APART)
        if apart is None:  # in a process without a server there is one loop
            await self.behind.handle(scope, receive, send)
        else:
            await apart(self._package, self.behind.handle, scope, receive, send)

    def _needs(self, scope: Scope) -> tuple[Need, ...]:
        """The needs of this request, the last of which counts; none where whoever is logged in may ask."""
        asked = next((each for each in self._leaves if each.matches(scope)[0] is Match.FULL), None)
        if asked is None:
            return (OPERATORS,)
        found = declared(getattr(asked, "dependencies", ()))
        return (OPERATORS,) if not found and method_of(scope) not in READS else found


def guarded(
    routes: Iterable[BaseRoute], point: EntryPoint, taken: set[str], pieces: Pieces
) -> list[BaseRoute]:
    """The routes of a package, each behind a look at who asks, without those with an address of the page,
    of a stop, or one that is `taken`. What the others have is taken then."""
    found: list[BaseRoute] = []
    for route in routes:
        mine = addresses([route])
        stops = {each for each in mine if is_stop(*each.split(" ", 1))}
        if doubled := mine & taken | stops | {each for each in KEPT if _answers(route, each)}:
            pieces.leave_out(piece_of(point, f"the route {min(doubled)}"), ArboledaError(TAKEN))
            continue
        taken |= mine
        found.append(PackageRoute(route, package_of(point)))
    return found


def _answers(route: BaseRoute, request: str) -> bool:
    """True if a route is for this request, as `GET /task.json`."""
    method, path = request.split()
    scope = {"type": "http", "method": method, "path": path, "root_path": "", "headers": []}
    return route.matches(scope)[0] is Match.FULL
