"""HTTP with one address, by httpx: a transport that blocks, and one for asyncio. The core is written once,
with `await`; over the transport that blocks nothing in it ever waits for a loop (`at_once`)."""

from __future__ import annotations

import json
import time
from collections.abc import AsyncGenerator, AsyncIterator, Coroutine, Iterator, Mapping
from contextlib import AbstractAsyncContextManager, asynccontextmanager, contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from arboleda.model.outside import text_of_error

from .errors import LONGEST, LibraryMissing, NoAnswer

if TYPE_CHECKING:  # slow to load, and only needed to ask a plant
    import ssl

    import httpx

TIMEOUT_S = 10.0
CONNECT_S = 2.5  # an address where no machine is answers nothing at all
Result = TypeVar("Result")


@dataclass(frozen=True, kw_only=True)
class HttpRequest:
    """Request as it is sent; `within_s` is the longest silence."""

    method: str
    url: str
    headers: Mapping[str, str] = field(default_factory=dict)
    body: Mapping[str, Any] | None = None
    within_s: float = TIMEOUT_S

    def options(self, connect_s: float) -> dict[str, Any]:
        """The arguments for httpx."""
        import httpx

        timeout = httpx.Timeout(TIMEOUT_S, connect=min(connect_s, self.within_s), read=self.within_s)
        return {"headers": dict(self.headers), "json": self.body, "timeout": timeout}


@dataclass(frozen=True, kw_only=True)
class Reply:
    """Answer as it came."""

    status: int
    headers: Mapping[str, str]
    text: str = ""

    @property
    def is_good(self) -> bool:
        return 200 <= self.status < 300

    def content(self) -> Any:
        """The JSON of it; NoAnswer for what no plant would say: no JSON, or a refusal without a sentence."""
        try:
            content = json.loads(self.text)
        except ValueError:
            raise _no_plant("it sends no JSON") from None
        if not self.is_good and not (isinstance(content, dict) and isinstance(content.get("sentence"), str)):
            raise _no_plant(f"status {self.status}")
        return content


@dataclass(frozen=True, kw_only=True)
class Stream:
    """Answer that goes on: a good one has `lines`, another one its text."""

    reply: Reply
    lines: AsyncIterator[str]


class Http(Protocol):
    """Transport; NoAnswer where there is no answer."""

    async def ask(self, request: HttpRequest) -> Reply: ...

    def stream(self, request: HttpRequest) -> AbstractAsyncContextManager[Stream]: ...

    async def sleep(self, seconds: float) -> None: ...

    async def close(self) -> None: ...


class BlockingHttp:
    """Http that blocks: no coroutine of it is ever suspended."""

    def __init__(self, tls: ssl.SSLContext | None = None, *, connect_s: float = CONNECT_S) -> None:
        self._connect_s = connect_s
        self._http: httpx.Client = _httpx().Client(**_settings(tls))

    async def ask(self, request: HttpRequest) -> Reply:
        with silence(request, self._connect_s):
            options = request.options(self._connect_s)
            return _reply(self._http.request(request.method, request.url, **options))

    @asynccontextmanager
    async def stream(self, request: HttpRequest) -> AsyncGenerator[Stream, None]:
        with silence(request, self._connect_s):
            options = request.options(self._connect_s)
            with self._http.stream(request.method, request.url, **options) as answer:
                if not answer.is_success:
                    answer.read()
                yield Stream(reply=_reply(answer), lines=_one_by_one(answer.iter_lines()))

    async def sleep(self, seconds: float) -> None:
        time.sleep(seconds)

    async def close(self) -> None:
        self._http.close()


class AsyncHttp:
    """Http in a loop of asyncio."""

    def __init__(self, tls: ssl.SSLContext | None = None, *, connect_s: float = CONNECT_S) -> None:
        self._connect_s = connect_s
        self._http: httpx.AsyncClient = _httpx().AsyncClient(**_settings(tls))

    async def ask(self, request: HttpRequest) -> Reply:
        with silence(request, self._connect_s):
            options = request.options(self._connect_s)
            return _reply(await self._http.request(request.method, request.url, **options))

    @asynccontextmanager
    async def stream(self, request: HttpRequest) -> AsyncGenerator[Stream, None]:
        with silence(request, self._connect_s):
            options = request.options(self._connect_s)
            async with self._http.stream(request.method, request.url, **options) as answer:
                if not answer.is_success:
                    await answer.aread()
                yield Stream(reply=_reply(answer), lines=answer.aiter_lines())

    async def sleep(self, seconds: float) -> None:
        import asyncio

        await asyncio.sleep(seconds)

    async def close(self) -> None:
        await self._http.aclose()


def at_once(work: Coroutine[Any, Any, Result]) -> Result:
    """The result of a coroutine that is never suspended."""
    try:
        work.send(None)
    except StopIteration as end:
        result: Result = end.value
        return result
    work.close()
    raise RuntimeError("it waits for a loop of asyncio, and there is none")


def each_at_once(items: AsyncGenerator[Result, None]) -> Iterator[Result]:
    """The items of a generator that is never suspended but to give one."""
    try:
        while True:
            try:
                item = at_once(_next(items))
            except StopAsyncIteration:
                return
            yield item
    finally:
        at_once(_end(items))


async def _next(items: AsyncGenerator[Result, None]) -> Result:
    return await items.__anext__()


async def _end(items: AsyncGenerator[Any, None]) -> None:
    await items.aclose()


async def _one_by_one(items: Iterator[str]) -> AsyncGenerator[str, None]:
    for item in items:
        yield item


@contextmanager
def silence(request: HttpRequest, connect_s: float) -> Iterator[None]:
    """Raises NoAnswer for an error of httpx."""
    import httpx

    try:
        yield
    except (httpx.HTTPError, httpx.InvalidURL) as error:
        was_sent = not isinstance(error, httpx.ConnectError | httpx.ConnectTimeout | httpx.InvalidURL)
        clause = reason(error, request, connect_s)
        raise NoAnswer(f"No answer of the plant{clause}", may_have_heard=was_sent, clause=clause) from error


def reason(error: BaseException, request: HttpRequest, connect_s: float) -> str:
    """The kind of silence, as the end of a sentence that begins with the plant's name."""
    import httpx

    url = str(httpx.URL(request.url).copy_with(raw_path=b"/")).rstrip("/")
    doubt = _doubt(error)
    if doubt is not None:
        return (
            f", and the certificate that is shown at {url} is not believed here ({doubt}): have this"
            " machine believe its authority, or name the file of that in $SSL_CERT_FILE; see"
            " docs/how-to/tls.md."
        )
    if isinstance(error, httpx.ConnectTimeout):
        return f", which cannot be reached at {url} (no connection in {connect_s:g} s)."
    if isinstance(error, httpx.ConnectError):
        return f", which cannot be reached at {url} ({text_of_error(error, LONGEST)})."
    if isinstance(error, httpx.TimeoutException):
        return f", which gave no answer at {url} in {request.within_s:g} s."
    return f", and what answers at {url} is no plant or broke off ({text_of_error(error, LONGEST)})."


def _doubt(error: BaseException | None) -> str | None:
    """The reason for which a certificate is not believed, if an error comes from that."""
    import ssl

    while error is not None:
        if isinstance(error, ssl.SSLCertVerificationError):
            return str(error.verify_message)
        error = error.__cause__ or error.__context__
    return None


def _no_plant(why: str) -> NoAnswer:
    return NoAnswer(
        f"What answers is no plant ({why}).",
        may_have_heard=True,
        clause=f", and what answers is no plant ({why}).",
    )


def _httpx() -> Any:
    try:
        import httpx
    except ImportError as error:
        raise LibraryMissing("httpx is not installed; type: pip install httpx") from error
    return httpx


def _settings(tls: ssl.SSLContext | None) -> dict[str, Any]:
    # A client goes straight to a plant, whatever proxy the environment names for the web. A redirect is not
    # followed blindly: where it leads to, another token counts.
    return {"trust_env": False, "follow_redirects": False, "verify": True if tls is None else tls}


def _reply(answer: httpx.Response) -> Reply:
    text = answer.text if answer.is_closed else ""
    return Reply(status=answer.status_code, headers=answer.headers, text=text)
