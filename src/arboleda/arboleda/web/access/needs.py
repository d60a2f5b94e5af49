"""Roles that the routes of packages need, as a route or its router declares them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from fastapi import Depends

from .auth import MAY, Forbidden, Role

RANKS = (None, Role.VIEWER, Role.ASSISTANT, Role.OPERATOR)  # each may do what those before it may


@dataclass(frozen=True, kw_only=True)
class Need:
    """The least role that may ask for a route; `act` says in English what others may not."""

    role: Role
    act: str

    async def __call__(self) -> None:
        """A dependency of a route that only declares: who serves the route has looked before."""

    def check(self, role: Role | None, act: str) -> None:
        """Raise Forbidden where this role is not enough; `act` is for a need that names none."""
        if RANKS.index(role) < RANKS.index(self.role):
            raise Forbidden(MAY[role].format(act=self.act or act))


def needs(role: Role, act: str = "") -> Any:
    """The declaration of who may ask, for `dependencies` of a route or of its router.

    Where both declare, the route's counts. Where none does, whoever is logged in may ask for what only reads
    (GET, HEAD), and an operator for all else.
    """
    return Depends(Need(role=role, act=act))


OPERATORS = Need(role=Role.OPERATOR, act="")


def declared(dependencies: Iterable[Any]) -> Need | None:
    """The last need among these dependencies of a route: those of its routers stand before its own."""
    found = [each.dependency for each in dependencies if isinstance(each.dependency, Need)]
    return found[-1] if found else None
