"""Limits of requests for routes of packages, as a route or its router declares them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fastapi import Depends

MOST_KILOBYTES = 4096  # a body is read whole, before anybody looks at it


@dataclass(frozen=True, kw_only=True, eq=False)
class Takes:
    """Limits of one route: the bytes of a body, and whether it is asked as often as a held button asks."""

    body_bytes: int
    held: bool

    async def __call__(self) -> None:
        """Do nothing as a dependency: who serves the route has looked at it before."""


def takes(*, kilobytes: int = 0, held: bool = False) -> Any:
    """The declaration of what a route takes, for `dependencies` of it or of its router.

    Without it a body may have 4 kilobytes; `kilobytes` is more than that. `held` is for a button that is
    held: it may ask 40 times a second. ValueError for more than MOST_KILOBYTES.
    """
    if not 0 <= kilobytes <= MOST_KILOBYTES:
        raise ValueError(f"a route takes {kilobytes} kilobytes; it may take {MOST_KILOBYTES}")
    return Depends(Takes(body_bytes=kilobytes * 1024, held=held))
