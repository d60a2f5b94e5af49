"""The desk of one browser: takes each of its requests, checks it and answers in words."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Awaitable
from concurrent.futures import Future
from typing import TypeVar

from fastapi.concurrency import run_in_threadpool
from nicegui import Client

from arboleda.core.advice import BY_HAND
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Outcome, Verb
from arboleda.model.sentence import Sentence, in_json
from arboleda.model.verbs import Arguments, as_text, lasting
from arboleda.store.task_rows import PAGE
from arboleda.web.access.auth import SUBMIT, allowed

from . import demo
from .feed import Feed
from .open_page import OpenPage
from .page_api import PageApi
from .wording import Words

ANSWER_S = 5.0
LOOK_S = 0.2
FOLLOWED_S = 120.0  # a homing may take a minute
DOWNLOAD = "download"
GOOD = {Outcome.UNDER_WAY: None, Outcome.UNCHECKED: None, Outcome.FAILED: False}

Answer = TypeVar("Answer")


class Desk(OpenPage):
    """Desk: the only way from the events of a page to the plant."""

    def __init__(self, client: Client, plant: PageApi, feed: Feed, words: Words) -> None:
        super().__init__(client, words, feed.seen)
        self._plant = plant
        self._feed = feed

    async def asked(self, act: str, of: str, more: object) -> None:
        """Do what the page asks for; `more` is True for what was done by hand, or has a verb's arguments."""
        if act == DOWNLOAD:
            self._download()
        elif act not in {SUBMIT, demo.END} and act not in VERBS:
            return
        elif not allowed(self.role, act):
            self.say(self._words("page.not_allowed", act=self._name(act)), good=False)
        elif act == SUBMIT:
            await self._submit(of)
        elif act == demo.END:
            self._plant.end_demo()
            self.say(self._words("demo.ended"), good=True)
        elif act != Verb.STOP or not self._is_stopped(of):
            await self._operate(Verb(act), of, more)

    def _name(self, act: str) -> str:
        return self._words("demo.end") if act == demo.END else self._words.of("verb", act)

    async def _submit(self, text: str) -> None:
        # The plant may look its id up in the history, and a stop must not wait for that.
        task = await self._answered(await run_in_threadpool(self._plant.submit, text, PAGE))
        if task is not None and task["state"] == "refused":
            self.say(self._words.say(task["sentence"]), good=False)
        elif task is not None:
            self.say(self._words("tasks.taken", text=task["text"], id=task["id"]), good=True)

    async def _operate(self, verb: Verb, scope: str, more: object) -> None:
        by_hand, arguments = more is True, _arguments(verb, more)
        call = self._plant.operate(verb, scope, by_hand=by_hand, arguments=arguments)
        answer = await self._answered(call)
        if answer is None:
            return
        if answer.refusal is not None:
            self.say(self._words.say(answer.refusal), good=False)
            return
        if (
            answer.outcome is Outcome.SENT and answer.why is not None
        ):  # a stop that left but could not be kept
            self.say(self._words.say(answer.why), good=False)
            return
        name = f"{verb.value}_by_hand" if by_hand and verb in BY_HAND else verb.value
        where = as_text(verb, scope, lasting(verb, arguments)) or self._words("panel.plant")
        act = {"what": self._words.of("verb", name), "where": where}
        self._tell(answer.outcome or Outcome.DONE, answer.why, act)
        if answer.outcome is Outcome.UNDER_WAY and answer.act is not None:
            await self._follow(answer.act, act)

    async def _follow(self, number: int, act: dict[str, str]) -> None:
        """Tell the page the outcome of an act, once it is known."""
        until = time.monotonic() + FOLLOWED_S
        while self.connected and time.monotonic() < until:
            await asyncio.sleep(LOOK_S)
            row = self._plant.act(number)
            if row is None:
                return
            if row["outcome"] != Outcome.UNDER_WAY.value:
                self._tell(Outcome(row["outcome"]), row["why"], act)
                return

    def _tell(self, outcome: Outcome, why: Sentence | None, act: dict[str, str]) -> None:
        reason = {} if why is None else {"why": self._words.say(why)}
        self.say(self._words(f"panel.{outcome.value}", **act, **reason), good=GOOD.get(outcome, True))

    async def _answered(self, future: Future[Answer]) -> Answer | None:
        """The plant's answer; None if there is none, after the page was told the reason."""
        waiting: Awaitable[Answer] = asyncio.shield(asyncio.wrap_future(future))
        try:
            return await asyncio.wait_for(waiting, ANSWER_S)
        except asyncio.TimeoutError:
            self.say(self._words("page.no_answer"), good=False)
        except ArboledaError as error:
            self.say(self._words.say(error.sentence), good=False)
        return None

    def _is_stopped(self, scope: str) -> bool:
        """True if a stop for this scope has already arrived another way, over HTTP."""
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


def _arguments(verb: Verb, more: object) -> Arguments:
    """The arguments of a verb in what a page sends."""
    values = more if isinstance(more, dict) else {}
    takes = [each for each in verb.arguments if type(values.get(each.name)) is each.type]
    return tuple((each.name, values[each.name]) for each in takes)


VERBS = frozenset(verb.value for verb in Verb)
