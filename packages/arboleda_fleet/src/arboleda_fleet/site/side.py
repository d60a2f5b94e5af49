"""The watcher of many plants as their page sees it; all of it runs in the server's event loop."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

from arboleda.extension import Sentence


@dataclass(frozen=True, kw_only=True)
class LastSeenPlant:
    """A plant as it was seen last.

    `name` is that of its row, `url` its page, "" if nobody leads it. `silent` is the reason for which it does
    not answer now, None if it does. `snapshot` is the last answer to `GET /api/plant`, `oee` that to `GET
    /api/oee`; `standbys` is the number of processes that stand by for it.
    """

    name: str
    url: str
    silent: Sentence | None = None
    snapshot: dict[str, Any] | None = None
    oee: list[dict[str, Any]] = field(default_factory=list)
    standbys: int = 0


@dataclass(frozen=True, kw_only=True)
class RequestOutcome:
    """The result of a request to plants."""

    good: bool
    sentence: Sentence


class SiteSide(Protocol):
    """The interface of the watcher of many plants, which also asks them for tasks and stops."""

    def plants(self) -> list[LastSeenPlant]: ...
    async def submit(self, plant: str, text: str) -> RequestOutcome: ...
    async def stop(self, plant: str = "") -> RequestOutcome:
        """Stop one plant by software, or all of them; the answer names those that did not answer."""
        ...

    def start(self) -> None: ...
    async def close(self) -> None: ...
