"""Roles that the routes of packages need, as a route or its router declares them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from fastapi import Depends, HTTPException
from starlette.requests import HTTPConnection
from starlette.types import Scope

from arboleda.model.outside import plain

from .auth import MAY, Forbidden, Role

RANKS = (None, Role.VIEWER, Role.ASSISTANT, Role.OPERATOR)  # each may do what those before it may
LOOKED = (
    "arboleda.looked"  # in the scope of a request: the needs that count, or that others take the place of
)


def reaches(role: Role | None, least: Role) -> bool:
    """True if a role may do what this one may."""
    return RANKS.index(role) >= RANKS.index(least)


@dataclass(frozen=True, kw_only=True, eq=False)  # FastAPI asks equal dependencies once
class Need:
    """The least role that may ask for a route; `act` says in English what others may not."""

    role: Role
    act: str

    async def __call__(self, connection: HTTPConnection) -> None:
        """Check a request, as a dependency, unless who serves the route has looked at this need before."""
        if any(self is each for each in connection.scope.get(LOOKED, ())):
            return
        try:
            self.check(connection.scope)
        except Forbidden as error:  # an application that a package mounts answers this one alone
            raise HTTPException(403, str(error)) from error

    def check(self, scope: Scope) -> None:
        """Raise Forbidden where the role of who asks is not enough."""
        role: Role | None = scope["arboleda.role"]
        if not reaches(role, self.role):
            act = self.act or f"{method_of(scope)} {plain(scope['path'], 80)}"
            raise Forbidden(MAY[role].format(act=act))


def needs(role: Role, act: str = "") -> Any:
    """The declaration of who may ask, for `dependencies` of a route or of its router.

    Where both declare, the route's counts. Anywhere else, as of a parameter or of an application that is
    mounted, each one counts. Where none does, whoever is logged in may ask for what only reads
    (GET, HEAD), and an operator for all else.
    """
    return Depends(Need(role=role, act=act))


OPERATORS = Need(role=Role.OPERATOR, act="")


def declared(dependencies: Iterable[Any]) -> tuple[Need, ...]:
    """The needs among these dependencies of a route: those of its routers stand before its own."""
    return tuple(each.dependency for each in dependencies if isinstance(each.dependency, Need))


def method_of(scope: Scope) -> str:
    """The method of a request; a websocket is no reading, as it may bring anything."""
    return str(scope.get("method", "websocket"))
