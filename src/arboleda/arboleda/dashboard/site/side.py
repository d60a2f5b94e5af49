"""What the page on many plants asks of whoever watches them; all of it in the server's event loop."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

from arboleda.model.sentence import Sentence


@dataclass(frozen=True, kw_only=True)
class LastSeenPlant:
    """A plant as it was seen last.

    `name` is that of its row, `url` its page, "" where nobody leads it. `silent` says why it does not answer
    now, None where it does. `snapshot` is what `GET /api/plant` said last, `oee` what `GET /api/oee` did;
    `standbys` how many processes are known to stand by for it.
    """

    name: str
    url: str
    silent: Sentence | None = None
    snapshot: dict[str, Any] | None = None
    oee: list[dict[str, Any]] = field(default_factory=list)
    standbys: int = 0


@dataclass(frozen=True, kw_only=True)
class RequestOutcome:
    """What became of something that was asked of plants."""

    good: bool
    sentence: Sentence


class SiteSide(Protocol):
    """Watches the plants, and asks them."""

    def plants(self) -> list[LastSeenPlant]: ...
    async def submit(self, plant: str, text: str) -> RequestOutcome: ...
    async def stop(self, plant: str = "") -> RequestOutcome:
        """The software stop of one plant, or of all of them; says which did not answer."""
        ...

    def start(self) -> None: ...
    async def close(self) -> None: ...
