"""HTTP with one process of a plant: that of a state directory here, or the leader on another host."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from arboleda.model.errors import ArboledaError, QueueFull, TextError
from arboleda.model.outside import plain, said_by
from arboleda.runtime.endpoints import Place
from arboleda.web.limits import BEAT_S
from arboleda.web.plant_api import COMMAND_LINE, PLANT

if TYPE_CHECKING:  # slow to load, and only needed to ask a plant
    import httpx

TIMEOUT_S = 10.0
FAR_CONNECT_S = 2.5  # an address where no machine is answers nothing at all
LONGEST = 300  # characters of what another host says that are shown
UNAUTHORIZED, UNAVAILABLE = 401, 503


class VerbRefused(ArboledaError):
    """The plant does not do now what an operator asks for; the sentence says why."""


class PlantSilent(ArboledaError):
    """No answer of a plant; `may_have_heard` if it may have done what was asked all the same."""

    def __init__(self, sentence: str, *, may_have_heard: bool) -> None:
        super().__init__(sentence)
        self.may_have_heard = may_have_heard


ERRORS = {403: ArboledaError, 404: ArboledaError, 409: VerbRefused, 422: TextError}


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Answer: status and content of a response; `is_for_now` if it may be another one a little later."""

    status: int
    said: Any
    is_for_now: bool = False

    @property
    def stands_by(self) -> bool:
        """True if the process that answers only waits to lead the plant."""
        return isinstance(self.said, dict) and self.said.get("standby") is True

    @property
    def sentence(self) -> str:
        return plain(str(self.said.get("sentence", "")) if isinstance(self.said, dict) else "", LONGEST)


class Line:
    """Line to a process of this host; `name` is its name in sentences."""

    connect_s = TIMEOUT_S
    host = "this host"

    def __init__(self, place: Place, name: str) -> None:
        self.place = place
        self._name = name

    def ask(
        self, method: str, path: str, body: dict[str, Any] | None = None, *, within_s: float = TIMEOUT_S
    ) -> Answer:
        """The answer of the plant, refusals too; PlantSilent if there is none."""
        import httpx

        try:
            with self._http(silence_s=within_s) as http:
                return _answer(http.request(method, f"{self.place.url}{path}", json=body))
        except (httpx.HTTPError, ValueError) as error:
            raise self._silent(error) from error

    def taken(self, answer: Answer) -> Any:
        """The content of an answer; a refusal raises the error that it stands for."""
        if answer.status < 300:
            return answer.said
        if answer.status == UNAVAILABLE and answer.is_for_now and not answer.stands_by:
            raise QueueFull(answer.sentence)
        raise self._refusal(answer)

    def events(self) -> Iterator[tuple[str, dict[str, Any]]]:
        """The events of `GET /api/events` up to its end; PlantSilent, or ArboledaError with its refusal."""
        import httpx

        kind = ""
        try:
            with (
                self._http(silence_s=2 * BEAT_S) as http,
                http.stream("GET", f"{self.place.url}/api/events") as answer,
            ):
                if not answer.is_success:
                    answer.read()
                    raise self._refusal(_answer(answer))
                for line in answer.iter_lines():
                    field, _, value = line.partition(": ")
                    if field == "event":
                        kind = value
                    elif field == "data":
                        yield kind, json.loads(value)
        except (httpx.HTTPError, ValueError) as error:
            raise self._silent(error) from error

    def _refusal(self, answer: Answer) -> ArboledaError:
        return ERRORS.get(answer.status, ArboledaError)(answer.sentence)

    def _how(self, error: Exception) -> str:
        """The kind of silence, as the end of a sentence that begins with the plant's name."""
        return " did not answer."

    def _silent(self, error: Exception) -> PlantSilent:
        import httpx

        was_sent = not isinstance(error, httpx.ConnectError | httpx.ConnectTimeout)
        return PlantSilent(f"{self._name}{self._how(error)}", may_have_heard=was_sent)

    def _http(self, *, silence_s: float = TIMEOUT_S) -> httpx.Client:
        import httpx

        # A command goes straight to a plant, whatever proxy the environment names for the web. A redirect is
        # not followed blindly: where it leads to, another token counts.
        return httpx.Client(
            trust_env=False,
            timeout=httpx.Timeout(TIMEOUT_S, connect=min(self.connect_s, silence_s), read=silence_s),
            headers=self._headers,
            verify=self.place.believed(),
            follow_redirects=False,
        )

    @property
    def _headers(self) -> dict[str, str]:
        headers = {"user-agent": COMMAND_LINE}
        if self.place.plant:
            headers[PLANT] = self.place.plant
        if self.place.token:
            headers["authorization"] = f"Bearer {self.place.token}"
        return headers


class FarLine(Line):
    """Line to the leader of a plant on another host; `token_advice` is the remedy for a refused token."""

    connect_s = FAR_CONNECT_S

    def __init__(self, place: Place, name: str, host: str, token_advice: str) -> None:
        super().__init__(place, name)
        self.host = host
        self._token_advice = token_advice

    def _refusal(self, answer: Answer) -> ArboledaError:
        if answer.stands_by:
            return ArboledaError(
                f"{self._name}, but what answers at {self.place.url} stands by: the leader changes just now,"
                " or that address leads to another process; try again in some seconds."
            )
        if answer.status in ERRORS:
            return super()._refusal(answer)
        refusal = f"{self._name}, which refuses this at {self.place.url}: {answer.sentence}"
        return ArboledaError(f"{refusal} {self._token_advice}" if answer.status == UNAUTHORIZED else refusal)

    def _how(self, error: Exception) -> str:
        import httpx

        url = self.place.url
        doubt = _doubt(error)
        if doubt is not None:
            return (
                f", and the certificate that is shown at {url} is not believed here ({doubt}): have this"
                " machine believe its authority, or name the file of that in $SSL_CERT_FILE; see"
                " docs/how-to/tls.md."
            )
        if isinstance(error, httpx.ConnectTimeout):
            return f", which cannot be reached at {url} (no connection in {FAR_CONNECT_S:g} s)."
        if isinstance(error, httpx.ConnectError):
            return f", which cannot be reached at {url} ({said_by(error, LONGEST)})."
        if isinstance(error, httpx.TimeoutException):
            return f", which gave no answer at {url} in {TIMEOUT_S:g} s."
        return f", and what answers at {url} is no plant or broke off ({said_by(error, LONGEST)})."


def _answer(answer: httpx.Response) -> Answer:
    """The answer in a response; ValueError if no plant gave it."""
    body = answer.json()
    if not answer.is_success and not (isinstance(body, dict) and isinstance(body.get("sentence"), str)):
        raise ValueError(f"status {answer.status_code}")
    return Answer(status=answer.status_code, said=body, is_for_now="retry-after" in answer.headers)


def _doubt(error: BaseException | None) -> str | None:
    """The reason for which a certificate is not believed, if an error comes from that."""
    import ssl

    while error is not None:
        if isinstance(error, ssl.SSLCertVerificationError):
            return str(error.verify_message)
        error = error.__cause__ or error.__context__
    return None
