"""Talks to the plant that runs on a state directory, for the commands that need one."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from arboleda.adapters.web.auth import Role
from arboleda.adapters.web.limits import BEAT_S
from arboleda.adapters.web.plant_side import COMMAND_LINE
from arboleda.model.errors import ArboledaError, QueueFull, TextError
from arboleda.model.messages import ENDED, TaskState, Verb
from arboleda.model.outside import plain

from . import tokens
from .state import Running, find_running, running_plants

if TYPE_CHECKING:  # they take a while to load, and only who asks a plant needs them
    import ssl

    import httpx

TIMEOUT_S = 10.0
LONGEST = 500  # characters of a path that is named


class Refused(ArboledaError):
    """The plant does not do now what an operator asks for; the sentence says why."""


class Gone(ArboledaError):
    """The plant was there, and is no more."""

    def __init__(self) -> None:
        super().__init__("the plant has ended")


ERRORS = {409: Refused, 422: TextError}


def _believed(running: Running) -> ssl.SSLContext | bool:
    """Whom a client believes: the certificate of that plant, as its state directory has it."""
    if not running.certificate:
        return True  # nobody is asked for one
    from arboleda.adapters.server_tls import pinned

    return pinned(running.certificate)


def _instead() -> str:
    """What to do where no plant runs on a state directory: those that run are named."""
    found = running_plants()
    if not found:
        return "start one with `arboleda up`, or name its directory where it was started with --state"
    named = ", ".join(f"{plain(path.name)} (--state {plain(str(path), LONGEST)})" for path in found)
    return f"{'the one that runs is' if len(found) == 1 else 'those that run are'} {named}"


class PlantClient:
    """One-sentence ArboledaErrors: no plant, no answer, or what the plant said."""

    def __init__(self, state: Path) -> None:
        self._state = state

    def submit(self, text: str) -> dict[str, Any]:
        """The queued task; TextError where the text is refused, QueueFull where the plant takes none now."""
        return self._ask("POST", "/api/tasks", {"text": text})

    def status(self) -> dict[str, Any]:
        """The view of the plant."""
        return self._ask("GET", "/api/plant")

    def task(self, task: str) -> dict[str, Any]:
        """One task by its id."""
        return self._ask("GET", f"/api/tasks/{task}")

    def operate(self, verb: Verb, scope: str = "", *, by_hand: bool = False) -> dict[str, Any]:
        """Have the plant (no scope) or one cell, robot, zone or task do it; Refused where it does not."""
        where = f"cells/{quote(scope, safe='')}" if scope else "plant"
        return self._ask("POST", f"/api/{where}/{verb.value}", {"by_hand": True} if by_hand else None)

    def changes(self) -> Iterator[tuple[str, dict[str, Any]]]:
        """What `GET /api/events` says, as it happens: the kind of each event and its row, `snapshot` first.

        A reader that was too slow is told a new snapshot; Gone where the plant has ended.
        """
        import httpx

        running, heard = self._running(), False
        while not heard or find_running(self._state) == running:
            try:
                for event in self._events(running):
                    heard = True
                    yield event
            except (httpx.HTTPError, ValueError, KeyError) as error:
                raise (Gone() if heard else self._silent(running)) from error
        raise Gone

    def _events(self, running: Running) -> Iterator[tuple[str, dict[str, Any]]]:
        """One stream, up to where it is cut; ArboledaError with what the plant said where it gives none."""
        kind = ""
        with (
            self._http(running, silence_s=2 * BEAT_S) as http,
            http.stream("GET", f"{running.url}/api/events") as answer,
        ):
            if not answer.is_success:
                answer.read()
                raise ArboledaError(answer.json()["sentence"])
            for line in answer.iter_lines():
                field, _, value = line.partition(": ")
                if field == "event":
                    kind = value
                elif field == "data":
                    yield kind, json.loads(value)

    def follow(self, task: dict[str, Any]) -> Iterator[dict[str, Any]]:
        """The task each time that its state changes, until it has ended; ArboledaError where the plant ends
        before."""
        if TaskState(task["state"]) in ENDED:
            return
        try:
            for now in self._told_of(task["id"]):
                if now["state"] != task["state"]:
                    yield (task := now)
                if TaskState(task["state"]) in ENDED:
                    return
        except Gone as error:
            raise ArboledaError(
                f"the plant has ended, and #{task['id']} has not: its next start has it again"
            ) from error

    def _told_of(self, id: str) -> Iterator[dict[str, Any]]:
        for kind, row in self.changes():
            rows = row["tasks"] if kind == "snapshot" else [row] if kind == "task" else []
            yield from (each for each in rows if each["id"] == id)

    def _running(self) -> Running:
        running = find_running(self._state)
        if running is None:
            raise ArboledaError(f"No plant is running on {self._state}; {_instead()}.")
        if running.port is None:
            raise ArboledaError(
                f"The plant on {self._state} (process {running.pid}) is still starting or ending."
            )
        return running

    def _http(self, running: Running, *, silence_s: float = TIMEOUT_S) -> httpx.Client:
        import httpx

        # No proxy of the environment stands between two processes of one machine.
        timeout = httpx.Timeout(TIMEOUT_S, read=silence_s)
        return httpx.Client(
            trust_env=False, timeout=timeout, headers=self._headers(running), verify=_believed(running)
        )

    def _silent(self, running: Running) -> ArboledaError:
        return ArboledaError(f"The plant on {self._state} (process {running.pid}) did not answer.")

    def _ask(self, method: str, path: str, body: dict[str, Any] | None = None) -> dict[str, Any]:
        running = self._running()
        import httpx

        try:
            with self._http(running) as http:
                answer = http.request(method, f"{running.url}{path}", json=body)
                said, sentence = answer.json(), ""
                if not answer.is_success:
                    sentence = said["sentence"]
        except (httpx.HTTPError, ValueError, TypeError, KeyError) as error:
            raise self._silent(running) from error
        if answer.is_success:
            return said
        if answer.status_code == 503 and "retry-after" in answer.headers:
            raise QueueFull(sentence)
        raise ERRORS.get(answer.status_code, ArboledaError)(sentence)

    def _headers(self, running: Running) -> dict[str, str]:
        """Who asks, with the operator's token where the plant wants one: whoever may read it may operate."""
        who = {"user-agent": COMMAND_LINE}
        if not running.guarded:
            return who
        return who | {"authorization": f"Bearer {tokens.TokenFile(self._state)()[Role.OPERATOR]}"}
