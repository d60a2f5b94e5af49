"""Plant and AsyncPlant: a plant that runs somewhere, over its HTTP API."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .calls import Awaiting, Blocking
from .http import AsyncHttp, BlockingHttp, Http, at_once
from .line import Line
from .methods import DraftAsPlant, DraftSteps, Faults, Looks, Proposals, Tasks, Trees, Verbs, Versions, new_id

if TYPE_CHECKING:
    import ssl

HERE = "http://127.0.0.1:8080"
PATIENCE_S = 30.0  # a plant that lost its leader has the next one by then


class Draft(Blocking, DraftSteps, DraftAsPlant):
    """Draft of a plant's files, as `Plant.draft` makes it; its steps are taken under the id of one editor."""


class AsyncDraft(Awaiting, DraftSteps, DraftAsPlant):
    """Draft of a plant's files, for asyncio: the methods of Draft, to be awaited."""


class Plant(Blocking, Looks, Tasks, Verbs, Versions, Faults, Trees, Proposals):
    """A plant that runs at one of these addresses, by default on this machine.

    `token` is the operator's, the viewer's or the assistant's; as a mapping, the token of each address.
    `plant` is the name of the one that is meant, and another one is refused. `tls` says which certificates
    are believed. Of a plant on two hosts name both addresses: the client follows whoever leads. Where nobody
    answers, what may be asked twice is asked again for `patience_s`.
    """

    def __init__(
        self,
        *addresses: str,
        token: str | Mapping[str, str] = "",
        plant: str = "",
        tls: ssl.SSLContext | None = None,
        patience_s: float = PATIENCE_S,
    ) -> None:
        http = BlockingHttp(tls)
        super().__init__(_line(http, addresses, token, plant, patience_s))

    def draft(self, editor: str = "") -> Draft:
        """The draft of its files, under the id of an editor or a new one; `take` begins to edit it."""
        return Draft(self._line, editor or new_id())

    def close(self) -> None:
        """Close its connections; idempotent."""
        at_once(self._line.http.close())

    def __enter__(self) -> Plant:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


class AsyncPlant(Awaiting, Looks, Tasks, Verbs, Versions, Faults, Trees, Proposals):
    """A plant, for asyncio: the methods of Plant, to be awaited."""

    def __init__(
        self,
        *addresses: str,
        token: str | Mapping[str, str] = "",
        plant: str = "",
        tls: ssl.SSLContext | None = None,
        patience_s: float = PATIENCE_S,
    ) -> None:
        super().__init__(_line(AsyncHttp(tls), addresses, token, plant, patience_s))

    def draft(self, editor: str = "") -> AsyncDraft:
        """The draft of its files, as `Plant.draft`."""
        return AsyncDraft(self._line, editor or new_id())

    async def close(self) -> None:
        """Close its connections; idempotent."""
        await self._line.http.close()

    async def __aenter__(self) -> AsyncPlant:
        return self

    async def __aexit__(self, *error: object) -> None:
        await self.close()


def _line(
    http: Http, addresses: tuple[str, ...], token: str | Mapping[str, str], plant: str, patience_s: float
) -> Line:
    tokens: Mapping[str, Any] = {"": token} if isinstance(token, str) else token
    return Line(http, addresses or (HERE,), tokens, plant=plant, patience_s=patience_s)
