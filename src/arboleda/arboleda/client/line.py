"""Line to a plant: requests at its addresses, where each finds the process that leads it. One core for the
client that blocks and for that of asyncio."""

from __future__ import annotations

import json
import time
from collections.abc import AsyncGenerator, AsyncIterator, Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from ipaddress import ip_address
from typing import Any
from urllib.parse import quote, urlencode, urlsplit

from arboleda import __version__

from .answers.plant import Event
from .errors import NoAnswer, OtherPlant, Refusal, refusal
from .http import TIMEOUT_S, Http, HttpRequest, Reply
from .protocol import BEAT_S, PLANT

LOOK_S = 0.25  # between two rounds through the addresses
AGENT = f"python-arboleda/{__version__}"  # one that begins with `arboleda` is the command line


@dataclass(frozen=True, kw_only=True)
class Call:
    """Request to a plant, wherever it is; `is_repeatable` if it may be heard twice and is done once."""

    method: str
    path: str
    query: Mapping[str, Any] = field(default_factory=dict)
    body: Mapping[str, Any] | None = None
    is_repeatable: bool = False
    within_s: float = TIMEOUT_S

    @property
    def target(self) -> str:
        given = {name: value for name, value in self.query.items() if value is not None}
        return f"{self.path}?{urlencode(given)}" if given else self.path


def path_of(template: str, values: Mapping[str, Any]) -> str:
    """The path of a route with these values in it."""
    return template.format(**{name: quote(str(value), safe="") for name, value in values.items()})


class Line:
    """Line to the process that leads a plant, at one of `addresses` or where a process that stands by says.

    `tokens` are by address, "" for all others. `plant` is its name, "" for whichever answers first: from then
    on that one. What may be asked again is, for `patience_s`.
    """

    def __init__(
        self,
        http: Http,
        addresses: Sequence[str],
        tokens: Mapping[str, str],
        *,
        plant: str = "",
        patience_s: float,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.http = http
        self._addresses = [each.rstrip("/") for each in addresses]
        self._tokens = {url.rstrip("/"): token for url, token in tokens.items()}
        self._plant = plant
        self._patience_s = patience_s
        self.clock = clock

    async def data(self, call: Call) -> Any:
        """The JSON of the answer; Refusal, or NoAnswer."""
        return (await self.reply(call)).content()

    async def reply(self, call: Call) -> Reply:
        """A good answer of the process that leads the plant; Refusal, or NoAnswer."""
        until = self.clock() + self._patience_s
        while True:
            try:
                return await self._round(call)
            except NoAnswer:
                if not call.is_repeatable or self.clock() >= until:
                    raise
            await self.http.sleep(LOOK_S)

    async def events(self, *, until: float | None = None) -> AsyncGenerator[Event, None]:
        """Changes as they happen, a snapshot first; up to `until` where that is given. After a cut it goes on
        after the last event, or with another snapshot. NoAnswer after `patience_s` of silence."""
        last, cut_at = "", None
        while until is None or self.clock() < until:
            try:
                async for event in self._events(last, until):
                    last, cut_at = event.id, None
                    yield event
                    if until is not None and self.clock() >= until:
                        return
                raise NoAnswer("The plant ended the stream of its events.", may_have_heard=False)
            except NoAnswer:
                now = self.clock()
                if until is not None and now >= until:
                    return
                cut_at = now if cut_at is None else cut_at
                if now - cut_at >= self._patience_s:
                    raise
            await self.http.sleep(LOOK_S)

    async def _round(self, call: Call) -> Reply:
        """Ask each address in turn, and the leader that one of them names."""
        ways = _Ways(self._addresses)
        silent: NoAnswer | Refusal | None = None
        for url in ways:
            try:
                reply = await self.http.ask(self._request(call, url))
                led = _led(reply, url)
                if led is None:
                    self._begin_with(url)
                    return reply
                silent = self._follow(led, ways)
            except (NoAnswer, OtherPlant) as error:
                silent = _more_telling(silent, error)
                if isinstance(error, NoAnswer) and error.may_have_heard and not call.is_repeatable:
                    raise
        assert silent is not None
        raise silent

    async def _events(self, last: str, until: float | None) -> AsyncGenerator[Event, None]:
        ways = _Ways(self._addresses)
        silent: NoAnswer | Refusal | None = None
        for url in ways:
            call = Call(method="GET", path="/api/events", within_s=self._silence_s(until))
            request = self._request(call, url, {"last-event-id": last} if last else {})
            leads = False
            try:
                async with self.http.stream(request) as stream:
                    led = None if stream.reply.is_good else _led(stream.reply, url)
                    if led is None:
                        self._begin_with(url)
                        leads = True
                        async for event in events_in(stream.lines):
                            yield event
                        return
                    silent = self._follow(led, ways)
            except (NoAnswer, OtherPlant) as error:
                if leads:  # whoever goes on has to know after which event
                    raise
                silent = _more_telling(silent, error)
        assert silent is not None
        raise silent

    def _silence_s(self, until: float | None) -> float:
        left = 2 * BEAT_S if until is None else until - self.clock()
        return min(2 * BEAT_S, max(left, 0.05))

    def _follow(self, led: _Led, ways: _Ways) -> NoAnswer:
        """Have the leader asked next, where it can be; returns what to say if nobody else answers."""
        self._plant = self._plant or led.plant
        if led.url:
            ways.insert(led.url)
        return led.silence

    def _begin_with(self, url: str) -> None:
        """Ask this address first from now on."""
        if self._addresses[0] != url:
            self._addresses = [url, *(each for each in self._addresses if each != url)]

    def _request(self, call: Call, url: str, more: Mapping[str, str] | None = None) -> HttpRequest:
        headers = {"user-agent": AGENT, **(more or {})}
        if self._plant:
            headers[PLANT] = self._plant
        token = self._tokens.get(url) or self._tokens.get("", "")
        if token:
            headers["authorization"] = f"Bearer {token}"
        return HttpRequest(
            method=call.method,
            url=f"{url}{call.target}",
            headers=headers,
            body=call.body,
            within_s=call.within_s,
        )


class _Ways:
    """Addresses of one round, each once; one that is inserted comes next."""

    def __init__(self, addresses: Sequence[str]) -> None:
        self._left = list(addresses)
        self._tried: set[str] = set()

    def insert(self, url: str) -> None:
        self._left.insert(0, url)

    def __iter__(self) -> _Ways:
        return self

    def __next__(self) -> str:
        while self._left:
            url = self._left.pop(0)
            if url not in self._tried:
                self._tried.add(url)
                return url
        raise StopIteration


@dataclass(frozen=True, kw_only=True)
class _Led:
    """Word of a process that stands by: the leader's address ("" where it cannot be used from here)."""

    plant: str
    url: str
    silence: NoAnswer


def _led(reply: Reply, url: str) -> _Led | None:
    """The leader as the process at `url` names it; None if that one leads itself. Refusal for an answer that
    is one."""
    if reply.is_good and '"standby"' not in reply.text:  # a text, or what only the leader says
        return None
    content = reply.content()
    if not stands_by(content):
        if not reply.is_good:
            raise refusal(reply.status, content, reply.headers.get("retry-after"))
        return None
    leader, sentence = str(content.get("leader", "")).rstrip("/"), str(content.get("sentence", ""))
    at, to = urlsplit(url), urlsplit(leader)
    # What asks over TLS shows its token to nobody without; a loopback address is the other host's own.
    is_safe = to.scheme == "https" or (to.scheme == "http" and at.scheme == "http")
    is_near = not _is_loopback(to.hostname) or _is_loopback(at.hostname)
    way = leader if is_safe and is_near else ""
    clause = f"What answers at {url} stands by: it {sentence}" if sentence else f"{url} stands by"
    if leader and not way:
        clause = f"{clause}; the leader's address {leader} cannot be used from here"
    silence = NoAnswer(clause, may_have_heard=False)
    return _Led(plant=str(content.get("plant", "")), url=way, silence=silence)


def stands_by(content: Any) -> bool:
    """True if the process that gives this answer only waits to lead the plant."""
    return isinstance(content, dict) and content.get("standby") is True


def _is_loopback(host: str | None) -> bool:
    try:
        return ip_address(host or "").is_loopback
    except ValueError:
        return host == "localhost"


def _more_telling(before: NoAnswer | Refusal | None, now: NoAnswer | Refusal) -> NoAnswer | Refusal:
    """The error to raise of those of one round: the first, of the address that answered last time."""
    return before if before is not None else now


async def events_in(lines: AsyncIterator[str]) -> AsyncGenerator[Event, None]:
    """The events in the lines of `GET /api/events`; NoAnswer for what is none."""
    event = Event(id="", kind="", row={})
    async for line in lines:
        name, _, value = line.partition(": ")
        if name == "id":
            event = replace(event, id=value)
        elif name == "event":
            event = replace(event, kind=value)
        elif name == "data":
            try:
                yield replace(event, row=json.loads(value))
            except ValueError:
                raise NoAnswer("What answers is no plant: it sends no JSON.", may_have_heard=True) from None
