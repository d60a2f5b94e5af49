"""Talks to the plant that runs on a state directory, for the commands that need one."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from urllib.parse import quote

import httpx

from arboleda.adapters.web.auth import Role
from arboleda.core.errors import ArboledaError, QueueFull, TextError
from arboleda.core.messages import Verb
from arboleda.core.outside import plain

from . import tokens
from .state import Running, find_running, running_plants

TIMEOUT_S = 10.0
LONGEST = 500  # characters of a path that is named


class Refused(ArboledaError):
    """The plant does not do now what an operator asks for; the sentence says why."""


ERRORS = {409: Refused, 422: TextError}


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

    def _ask(self, method: str, path: str, body: dict[str, Any] | None = None) -> dict[str, Any]:
        running = find_running(self._state)
        if running is None:
            raise ArboledaError(f"No plant is running on {self._state}; {_instead()}.")
        if running.port is None:
            raise ArboledaError(
                f"The plant on {self._state} (process {running.pid}) is still starting or ending."
            )
        try:
            # No proxy of the environment stands between two processes of one machine.
            with httpx.Client(trust_env=False, timeout=TIMEOUT_S, headers=self._login(running)) as client:
                answer = client.request(method, f"{running.url}{path}", json=body)
                said, sentence = answer.json(), ""
                if not answer.is_success:
                    sentence = said["sentence"]
        except (httpx.HTTPError, ValueError, TypeError, KeyError) as error:
            raise ArboledaError(
                f"The plant on {self._state} (process {running.pid}) did not answer."
            ) from error
        if answer.is_success:
            return said
        if answer.status_code == 503 and "retry-after" in answer.headers:
            raise QueueFull(sentence)
        raise ERRORS.get(answer.status_code, ArboledaError)(sentence)

    def _login(self, running: Running) -> dict[str, str]:
        """The operator's token where the plant wants one: whoever may read it may operate."""
        if not running.guarded:
            return {}
        return {"authorization": f"Bearer {tokens.TokenFile(self._state)()[Role.OPERATOR]}"}
