"""Answer to requests that no route takes: 405 with the methods that there are, or 404."""

from __future__ import annotations

from collections.abc import Sequence

from starlette.exceptions import HTTPException
from starlette.routing import BaseRoute, Match
from starlette.types import Receive, Scope, Send

from .request_head import is_api


class NotFound(BaseRoute):
    """The last of the `routes`. Pages are mounted after it, and take every path; without it they would
    answer for a route of ours that was asked with another method."""

    def __init__(self, routes: Sequence[BaseRoute]) -> None:
        self._routes = tuple(routes)

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        if scope["type"] != "http":
            return Match.NONE, {}
        methods = self._methods(scope)
        ours = methods or is_api(scope["path"])
        return (Match.FULL if ours else Match.NONE), {"arboleda.methods": methods}

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        methods = ", ".join(scope["arboleda.methods"])
        if not methods:
            raise HTTPException(404, "There is nothing here; /api/docs lists what there is.")
        raise HTTPException(405, f"Here one can {methods} only.", {"allow": methods})

    def _methods(self, scope: Scope) -> list[str]:
        known = [route for route in self._routes if route.matches(scope)[0] is Match.PARTIAL]
        return sorted({method for route in known for method in getattr(route, "methods", None) or ()})
