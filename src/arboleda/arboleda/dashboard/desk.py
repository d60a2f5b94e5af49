"""What one browser may ask for: every request comes in here, is checked here, and is answered in words."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable
from concurrent.futures import Future
from typing import TypeVar

from nicegui import Client
from nicegui.events import GenericEventArguments

from arboleda.adapters.task_rows import PAGE
from arboleda.adapters.web.auth import SUBMIT, Role, allowed
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Verb
from arboleda.model.sentence import in_json

from .feed import Feed
from .plant_side import PlantSide
from .wording import Words

ANSWER_S = 5.0
LONGEST = 300  # characters of what a browser may name
DOWNLOAD, SEEN = "download", "seen"

Answer = TypeVar("Answer")


class Desk:
    """One open page: a viewer of the feed, and the only way from its events to the plant."""

    def __init__(self, client: Client, plant: PlantSide, feed: Feed, words: Words) -> None:
        self.language = words.language
        self._client = client
        self._plant = plant
        self._feed = feed
        self._words = words

    @property
    def connected(self) -> bool:
        return self._client.has_socket_connection

    @property
    def _role(self) -> Role | None:
        """The role of the connection behind the page, as the guard put it into its scope."""
        return (self._client.environ or {}).get("asgi.scope", {}).get("arboleda.role")

    def show(self, number: int, patch: str) -> None:
        """Send one frame."""
        self._client.run_javascript(f"arboleda.live({number}, {patch})")

    async def hear(self, event: GenericEventArguments) -> None:
        """One event of the page: [act, of, by_hand]; anything else is ignored."""
        asked = event.args if isinstance(event.args, list) else [event.args]
        act, of, by_hand = [*asked, None, None, None][:3]
        if act == SEEN and isinstance(of, int):
            self._feed.seen(self, of)
        elif isinstance(act, str) and isinstance(of, str) and len(of) <= LONGEST:
            await self._do(act, of, by_hand=by_hand is True)

    async def _do(self, act: str, of: str, *, by_hand: bool) -> None:
        if act == DOWNLOAD:
            self._download()
        elif act != SUBMIT and act not in VERBS:
            return
        elif not allowed(self._role, act):
            self._say(self._words("page.not_allowed", act=self._words.of("verb", act)), good=False)
        elif act == SUBMIT:
            await self._submit(of)
        elif act != Verb.STOP or not self._is_stopped(of):
            await self._operate(Verb(act), of, by_hand=by_hand)

    async def _submit(self, text: str) -> None:
        task = await self._answered(self._plant.submit(text, PAGE))
        if task is not None and task["state"] == "refused":
            self._say(self._words.say(task["sentence"]), good=False)
        elif task is not None:
            self._say(self._words("tasks.taken", text=task["text"], id=task["id"]), good=True)

    async def _operate(self, verb: Verb, scope: str, *, by_hand: bool) -> None:
        answer = await self._answered(self._plant.operate(verb, scope, by_hand=by_hand))
        if answer is None:
            return
        what = self._words.of("verb", verb.value)
        where = _without_number(scope) if verb is Verb.ANSWER else scope or self._words("panel.plant")
        done = self._words("panel.done", what=what, where=where)
        self._say(
            done if answer.refusal is None else self._words.say(answer.refusal), good=not answer.refusal
        )

    async def _answered(self, future: Future[Answer]) -> Answer | None:
        """What the plant answers; None once the page was told why there is no answer."""
        waiting: Awaitable[Answer] = asyncio.shield(asyncio.wrap_future(future))
        try:
            return await asyncio.wait_for(waiting, ANSWER_S)
        except asyncio.TimeoutError:
            self._say(self._words("page.no_answer"), good=False)
        except ArboledaError as error:
            self._say(self._words.say(error.sentence), good=False)
        return None

    def _is_stopped(self, scope: str) -> bool:
        """Whether a stop has arrived by the other way, over HTTP."""
        snapshot = self._plant.snapshot()
        names = {
            device["name"]
            for cell in snapshot["cells"]
            if scope in ("", cell["name"])
            for device in cell["devices"]
        }
        robots = [robot for robot in snapshot["robots"] if robot["name"] in (names or {scope})]
        return bool(robots) and all(robot["latched"] for robot in robots)

    def _download(self) -> None:
        whole = json.dumps(self._feed.events, ensure_ascii=False, indent=1, default=in_json)
        self._client.download(whole.encode(), "arboleda-timeline.json", "application/json")

    def _say(self, sentence: str, *, good: bool) -> None:
        self._client.run_javascript(f"arboleda.answer({json.dumps(sentence)}, {json.dumps(good)})")


def _without_number(scope: str) -> str:
    """A person and an answer as people say them: without the number of the question."""
    return " ".join(word for word in scope.split() if not word.startswith("#"))


VERBS = frozenset(verb.value for verb in Verb)
Hear = Callable[[GenericEventArguments], Awaitable[None]]
