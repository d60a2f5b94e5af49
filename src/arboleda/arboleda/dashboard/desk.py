"""The desk of one browser: takes each of its requests, checks it and answers in words."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Awaitable, Mapping
from concurrent.futures import Future
from typing import TypeVar

from fastapi.concurrency import run_in_threadpool

from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Outcome, Verb
from arboleda.model.outside import plain
from arboleda.model.sentence import in_json
from arboleda.store.task_rows import PAGE
from arboleda.web.access.auth import SUBMIT, allowed
from arboleda.web.access.needs import reaches

from . import outcomes
from .feed import Feed
from .open_page import OpenPage
from .outcomes import Said
from .page_api import PageApi
from .page_part import PageAct, Request
from .toolkit import Client
from .wording import Words

ANSWER_S = 5.0
LOOK_S = 0.2
FOLLOWED_S = 120.0  # a homing may take a minute
DOWNLOAD = "download"
LONGEST_ACT = 80  # characters

Answer = TypeVar("Answer")


class Desk(OpenPage):
    """Desk: the only way from the events of a page to the plant."""

    def __init__(
        self,
        client: Client,
        plant: PageApi,
        feed: Feed,
        words: Words,
        acts: Mapping[str, PageAct] | None = None,
    ) -> None:
        super().__init__(client, words, feed.note_shown)
        self._acts = acts or {}  # of packages
        self._plant = plant
        self._feed = feed

    async def take(self, act: str, of: str, more: object) -> None:
        """Do what the page asks for; `more` is True for what was done by hand, or has a verb's arguments."""
        if act == DOWNLOAD:
            self._download()
        elif act not in self._acts and act != SUBMIT and act not in VERBS:
            self.say(self._words("page.no_act", act=plain(act, LONGEST_ACT)), good=False)
        elif not self._may(act):
            self.say(self._words("page.not_allowed", act=self._name(act)), good=False)
        elif act == SUBMIT:
            await self._submit(of)
        elif act not in VERBS:
            await self._acts[act].take(self._request(act, of, more))
        elif act != Verb.STOP or not self._is_stopped(of):
            await self._operate(Verb(act), of, more)

    def _may(self, act: str) -> bool:
        added = self._added(act)
        return allowed(self.role, act) if added is None else reaches(self.role, added.role)

    def _added(self, act: str) -> PageAct | None:
        """The act of a package that has this word; None for one of the runner."""
        return None if act in (*VERBS, SUBMIT) else self._acts.get(act)

    def _request(self, act: str, of: str, more: object) -> Request:
        assert self.role is not None  # one that may do nothing asks for nothing
        return Request(
            act=act, of=of, more=more, role=self.role, plant=self._plant, words=self._words, say=self.say
        )

    def _name(self, act: str) -> str:
        added = self._added(act)
        if added is None:
            return self._words.of("verb", act)
        name = self._words.say(added.name)
        return self._words.flat.get(name, name)

    async def _submit(self, text: str) -> None:
        # The plant may look its id up in the history, and a stop must not wait for that.
        task = await self._answered(await run_in_threadpool(self._plant.submit, text, PAGE))
        if task is not None:
            self._tell(outcomes.of_task(self._words, task))

    async def _operate(self, verb: Verb, scope: str, more: object) -> None:
        by_hand, arguments = more is True, outcomes.arguments_of(verb, more)
        call = self._plant.operate(verb, scope, by_hand=by_hand, arguments=arguments)
        answer = await self._answered(call)
        if answer is None:
            return
        act = outcomes.act(self._words, verb, scope, arguments, by_hand=by_hand)
        self._tell(outcomes.of_answer(self._words, answer, act))
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
                self._tell(outcomes.of_outcome(self._words, Outcome(row["outcome"]), row["why"], act))
                return

    def _tell(self, answer: Said) -> None:
        sentence, good = answer
        self.say(sentence, good=good)

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


VERBS = frozenset(verb.value for verb in Verb)
