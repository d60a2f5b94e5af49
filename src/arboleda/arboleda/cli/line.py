"""HTTP with one process of a plant: that of a state directory here, or the leader on another host."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from arboleda.client.errors import BY_STATUS, NoAnswer, refusal
from arboleda.client.http import CONNECT_S, TIMEOUT_S, BlockingHttp, HttpRequest, Reply, at_once, each_at_once
from arboleda.client.line import events_in, stands_by
from arboleda.client.protocol import BEAT_S, COMMAND_LINE, PLANT
from arboleda.model.errors import ArboledaError
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase, Sentence
from arboleda.runtime.endpoints import Place

from .language import finding, say, say_row

LONGEST = 300  # characters of what another host says that are shown
UNAUTHORIZED = 401
OWN = {403, 404, 409, 422}  # what a plant refuses with a sentence that needs no other word


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Answer: status and content of a response, a refusal too, and its headers."""

    status: int
    body: Any
    headers: Mapping[str, str]

    @property
    def is_for_now(self) -> bool:
        """True if it may be another one a little later."""
        return "retry-after" in self.headers

    @property
    def stands_by(self) -> bool:
        """True if the process that answers only waits to lead the plant."""
        return stands_by(self.body)

    @property
    def sentence(self) -> str:
        return plain(str(self.body.get("sentence", "")) if isinstance(self.body, dict) else "", LONGEST)


SILENT = Phrase("cli.line.silent", "{name} did not answer.")
LEADER_CHANGES = Phrase(
    "cli.line.leader_changes",
    "{name}, but what answers at {url} stands by: the leader changes just now, or that address leads to "
    "another process; try again in some seconds.",
)
REFUSES = Phrase("cli.line.refuses", "{name}, which refuses this at {url}: {why}")
REFUSES_TOKEN = Phrase("cli.line.refuses_token", "{refusal} {advice}")


class Line:
    """Line to a process of this host; `name` is its name in sentences."""

    connect_s = TIMEOUT_S
    host = "this host"

    def __init__(self, place: Place, name: Sentence) -> None:
        self.place = place
        self._name = name

    def ask(
        self, method: str, path: str, body: dict[str, Any] | None = None, *, within_s: float = TIMEOUT_S
    ) -> Answer:
        """The answer of the plant, refusals too; NoAnswer if there is none."""
        with self._http() as http:
            return _answer(at_once(http.ask(self._request(method, path, within_s, body))))

    def taken(self, answer: Answer) -> Any:
        """The content of an answer; a refusal raises the error that it stands for."""
        if answer.status < 300:
            return answer.body
        raise self._refusal(answer)

    def events(self) -> Iterator[tuple[str, dict[str, Any]]]:
        """The events of `GET /api/events` up to its end; NoAnswer, or ArboledaError with its refusal."""
        with self._http() as http:
            for event in each_at_once(self._events(http)):
                yield event.kind, dict(event.row)

    async def _events(self, http: BlockingHttp) -> AsyncGenerator[Any, None]:
        async with http.stream(self._request("GET", "/api/events", 2 * BEAT_S)) as stream:
            if not stream.reply.is_good:
                raise self._refusal(_answer(stream.reply))
            async for event in events_in(stream.lines):
                yield event

    def _refusal(self, answer: Answer) -> ArboledaError:
        return refusal(answer.status, answer.body, answer.headers.get("retry-after"))

    def _silent(self, error: NoAnswer) -> str:
        return say(SILENT(name=self._name))

    @contextmanager
    def _http(self) -> Iterator[BlockingHttp]:
        http = BlockingHttp(self.place.believed(), connect_s=self.connect_s)
        try:
            yield http
        except NoAnswer as error:
            raise NoAnswer(self._silent(error), may_have_heard=error.may_have_heard) from error
        finally:
            at_once(http.close())

    def _request(
        self, method: str, path: str, within_s: float, body: dict[str, Any] | None = None
    ) -> HttpRequest:
        headers = {"user-agent": COMMAND_LINE}
        if self.place.plant:
            headers[PLANT] = self.place.plant
        if self.place.token:
            headers["authorization"] = f"Bearer {self.place.token}"
        url = f"{self.place.url}{path}"
        return HttpRequest(method=method, url=url, headers=headers, body=body, within_s=within_s)


class FarLine(Line):
    """Line to the leader of a plant on another host; `token_advice` is the remedy for a refused token."""

    connect_s = CONNECT_S

    def __init__(self, place: Place, name: Sentence, host: str, token_advice: Sentence) -> None:
        super().__init__(place, name)
        self.host = host
        self._token_advice = token_advice

    def _refusal(self, answer: Answer) -> ArboledaError:
        if answer.stands_by:
            return ArboledaError(LEADER_CHANGES(name=self._name, url=self.place.url))
        if answer.status in OWN or (answer.is_for_now and answer.status not in BY_STATUS):
            return super()._refusal(answer)
        refusal = REFUSES(name=self._name, url=self.place.url, why=plain(say_row(answer.body), LONGEST))
        if answer.status == UNAUTHORIZED:
            return ArboledaError(REFUSES_TOKEN(refusal=refusal, advice=self._token_advice))
        return ArboledaError(refusal)

    def _silent(self, error: NoAnswer) -> str:
        return f"{say(self._name)}{finding(error.clause)}"


def _answer(reply: Reply) -> Answer:
    """The answer in a reply; NoAnswer if no plant gave it."""
    return Answer(status=reply.status, body=reply.content(), headers=reply.headers)
