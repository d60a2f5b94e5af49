"""Plant and AsyncPlant: a plant that runs somewhere, over its HTTP API."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .added import Added
from .calls import Awaiting, Blocking
from .http import AsyncHttp, BlockingHttp, Http, at_once
from .line import Line
from .methods import Asking, Looks, Tasks, Verbs

if TYPE_CHECKING:
    import ssl

HERE = "http://127.0.0.1:8080"
PATIENCE_S = 30.0  # a plant that lost its leader has the next one by then


class Plant(Blocking, Looks, Tasks, Verbs, Asking, Added):
    """A plant that runs at one of these addresses, by default on this machine.

    `token` is the operator's, the viewer's or the assistant's; as a mapping, the token of each address.
    `plant` is the name of the one that is meant, and another one is refused. `tls` says which certificates
    are believed. Of a plant on two hosts name both addresses: the client follows whoever leads. Where nobody
    answers, what may be asked twice is asked again for `patience_s`. Installed packages add methods to it, as
    `draft`, `report` and `oee`.
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

    def close(self) -> None:
        """Close its connections; idempotent."""
        at_once(self._line.http.close())

    def __enter__(self) -> Plant:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


class AsyncPlant(Awaiting, Looks, Tasks, Verbs, Asking, Added):
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
