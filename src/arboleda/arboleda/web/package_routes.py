"""Routes of packages: each is asked only by whom it needs, and is made apart from those of others."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from importlib.metadata import EntryPoint
from typing import Any

from fastapi import FastAPI, routing
from starlette.routing import BaseRoute, Match, Mount
from starlette.types import Receive, Scope, Send

from arboleda.host.packages import package_of
from arboleda.host.pieces import RUNNER, Piece, Pieces, piece_of
from arboleda.model.errors import ArboledaError

from .access.needs import LOOKED, OPERATORS, Need, declared, method_of
from .access.takes import Takes
from .request import HISTORY, PAGE, READS, SCENE, TASK, is_stop

NEEDS = "arboleda.needs"  # in the scope of a request for a route of a package, the last one counts
ASKED = "arboleda.asked"  # in the scope of such a request: the route, as people are told of it
APART = "arboleda.apart"  # in the scope of each request: what runs an application in the loop of a package
STOPS = ("plant", "cells/x", "plants", "plants/x")
KEPT = (
    *(f"GET {each}" for each in (PAGE, TASK, HISTORY, SCENE)),  # of the page, which is asked after all routes
    *(f"POST /api/{each}/stop" for each in STOPS),
)
TAKEN = "{whose} has this address already"


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
    """Route of a package, or router that it has included, for those whose role is enough.

    It answers nothing but why where `part`, which it belongs to, is left out.
    """

    def __init__(self, route: BaseRoute, point: EntryPoint, pieces: Pieces, part: Piece) -> None:
        self.behind = route
        self._point = point
        self._pieces = pieces
        self._part = part
        self.methods = getattr(route, "methods", None)
        self._leaves = leaves([route])
        self._taking = [(each, found) for each in self._leaves if (found := _takes(each)) is not None]

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        if is_stop(method_of(scope), scope["path"]):  # made in the server's loop, in which nothing may hang
            return Match.NONE, {}
        match, found = self.behind.matches(scope)
        if match is not Match.FULL:
            return match, found
        return match, {**found, NEEDS: self._needs(scope)}  # what is found changes the scope

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        scope[ASKED] = piece_of(self._point, f"the route {method_of(scope)} {scope['path']}")
        scope[LOOKED] = scope.pop(NEEDS, (OPERATORS,))
        for need in scope[LOOKED][-1:]:
            need.check(scope)
        if why := self._pieces.why_not(self._part):
            raise ArboledaError(why)
        apart = scope.get(APART)
        if apart is None:  # in a process without a server there is one loop
            await self.behind.handle(scope, receive, send)
        else:
            await apart(package_of(self._point), self.behind.handle, scope, receive, send)

    def takes(self, scope: Scope) -> Takes | None:
        """Its limits for this request; None for the usual ones, and for a request of another route."""
        return next((found for each, found in self._taking if each.matches(scope)[0] is Match.FULL), None)

    def _needs(self, scope: Scope) -> tuple[Need, ...]:
        """The needs of this request, the last of which counts; none where whoever is logged in may ask."""
        asked = next((each for each in self._leaves if each.matches(scope)[0] is Match.FULL), None)
        if asked is None:
            return (OPERATORS,)
        found = declared(getattr(asked, "dependencies", ()))
        return (OPERATORS,) if not found and method_of(scope) not in READS else found


def taking(app: FastAPI) -> Callable[[Scope], Takes | None]:
    """A function that gives the limits that the route of a package declares for a request, if any."""

    def taken(scope: Scope) -> Takes | None:
        mine = (each.takes(scope) for each in app.router.routes if isinstance(each, PackageRoute))
        return next((each for each in mine if each is not None), None)

    return taken


def breadth(route: BaseRoute) -> tuple[bool, int]:
    """The breadth of what a route takes: whether it takes whole folders, and how many parts of its address
    may be anything."""
    paths = [str(getattr(each, "path", "")) for each in leaves([getattr(route, "behind", route)])]
    is_whole = isinstance(getattr(route, "behind", route), Mount) or any(":path}" in each for each in paths)
    return is_whole, max((each.count("{") for each in paths), default=0)


def guarded(
    routes: Iterable[BaseRoute], point: EntryPoint, taken: dict[str, str], pieces: Pieces, part: Piece
) -> list[BaseRoute]:
    """The routes of a package's part, each behind a look at who asks, without those with an address of the
    page, of a stop, or one that is `taken`: these, each with whose it is. What the others have is taken then.
    """
    found: list[BaseRoute] = []
    for route in routes:
        mine = addresses([route])
        stops = {each for each in mine if is_stop(*each.split(" ", 1))}
        if doubled := mine & taken.keys() | stops | {each for each in KEPT if _answers(route, each)}:
            first = min(doubled)
            pieces.leave_out_taken(piece_of(point, f"the route {first}"), taken.get(first, RUNNER), TAKEN)
            continue
        taken |= dict.fromkeys(mine, package_of(point))
        found.append(PackageRoute(route, point, pieces, part))
    return found


def _answers(route: BaseRoute, request: str) -> bool:
    """True if a route is for this request, as `GET /task.json`."""
    method, path = request.split()
    scope = {"type": "http", "method": method, "path": path, "root_path": "", "headers": []}
    return route.matches(scope)[0] is Match.FULL


def _takes(route: Any) -> Takes | None:
    """The last declaration of its limits: its router's stands before its own."""
    found = (each.dependency for each in reversed(getattr(route, "dependencies", ())))
    return next((each for each in found if isinstance(each, Takes)), None)
