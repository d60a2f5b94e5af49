"""A plant that answers what a test of the web server prepared, and notes what it was asked."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from typing import Any

import pytest

from arboleda.departures.leaving import stop_left
from arboleda.model.messages import OperatorAnswer, Verb
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.text import alternatives, spelled
from arboleda.model.verbs import Arguments
from arboleda.oee.figures import Oee, PastTask, PastTimes, PlantRun, oee
from arboleda.store.task_rows import TaskQuery, TaskRow
from arboleda.testing import shipped
from arboleda.web.access.auth import Role

QUEUED = {"id": "t-1", "text": "sis_a 0b 7", "cell": "sis_a", "state": "queued", "sentence": ""}
PROMISE = {"hindrance": None, "full": False}
TASK = QUEUED | {"reason": None, "elapsed_s": None}
VIEW = {"plant": "demo", "epoch": 7, "at": 1.0, "ending": False, "cells": [], "robots": [], "zones": []}
VIEW |= {"tasks": [TASK]}
WIDTH = {"name": "width", "called": "width", "type": "choice", "choices": ["5"]}
OFFER = {
    "name": "cut",
    "about": "Cut it.",
    "default": False,
    "form": "<cell> cut <width>",
    "example": "saw cut 5",
}
OFFERS = [{"cell": "saw", "recipes": [OFFER | {"parameters": [WIDTH]}]}]
LATE = Phrase("late", "{robot} was late")(robot="ra1")
FAILED = PastTask(
    cell="sis_a", order="sis_a 0B 7", state="failed", accepted_s=0.0, started_s=0.0, ended_s=50.0
)
RAN = PlantRun(since_s=0.0, seen_s=100.0, ended=True)
FIGURES = PastTimes(works=[FAILED], runs=[RAN], downs=[], shortest={})
KEPT = [
    TaskRow(
        number=number,
        id=f"t-{number}",
        text=f"{cell} 0B 7",
        cell=cell,
        recipe="storage",
        state="failed",
        reason="deadline",
        sentence=str(LATE),
        said=json.dumps(LATE.data()),
        accepted_s=1000.0 + number,
        started_s=1001.0 + number,
        ended_s=None,
        unchecked="release" if number == 2 else None,
    )
    for number, cell in ((2, "sis_b"), (1, "sis_a"))
]
TOKENS = {Role.VIEWER: "v" * 32, Role.OPERATOR: "o" * 32}


class Plant:
    """Answers each text with what was prepared for it."""

    def __init__(self) -> None:
        self.offered: dict[type, Any] = {}  # what packages ask for by kind
        self.reports: Iterator[str | None] = iter(())
        self.texts: list[str] = []
        self.choices: list[str] = []
        self.seconds = 60.0
        self.asked_by: list[str] = []
        self.forms: list[tuple] = []
        self.queries: list[TaskQuery] = []
        self.oee_queries: list[Any] = []
        self.answer: dict | Exception | None = QUEUED
        self.view: dict | Exception = VIEW
        self.acts: list[tuple[Verb, str, bool]] = []
        self.refusal: str | None = None
        self.unkept: Sentence | None = None  # why a stop that has left is not kept
        self.told: dict = {}  # of the answer to an act that is not refused
        self.rows: dict[int, dict] = {}
        self.unanswered: list[Future] | None = None
        self.watchers: list[Callable[[dict], None]] = []

    def snapshot(self) -> dict:
        if isinstance(self.view, Exception):
            raise self.view
        return self.view

    def latest(self) -> dict:
        return self.snapshot()

    def offers(self) -> list[dict]:
        return OFFERS

    def spelled(self, *, cell: str, recipe: str, values: dict, id: str) -> str:
        self.forms.append((cell, recipe, values, id))
        return spelled(shipped(), cell=cell, recipe=recipe, values=values, id=id)

    def find(self, task: str) -> dict | None:
        return QUEUED if task == QUEUED["id"] else None

    def history(self, query: TaskQuery) -> list[TaskRow]:
        self.queries.append(query)
        return [row for row in KEPT if query.cell in ("", row.cell)]

    def ask(self, kind: type) -> Any:
        return self.offered.get(kind)

    def report(self, task: str) -> str | None:
        return next(self.reports)

    def oee(self, query: Any) -> list[Oee]:
        self.oee_queries.append(query)
        return [oee("sis_a", FIGURES, 0.0, 100.0)]

    def promises(self, text: str) -> list[dict]:
        return [
            {**PROMISE, "text": each.text, "cell": each.cell, "seconds": self.seconds}
            for each in alternatives(text, shipped())
        ]

    def submit(self, text: str, asked_by: str, choice: str = "") -> Future:
        self.texts.append(text)
        self.choices.append(choice)
        self.asked_by.append(asked_by)
        future: Future = Future()
        if isinstance(self.answer, Exception):
            future.set_exception(self.answer)
        elif self.answer is not None:
            future.set_result(self.answer)
        return future

    def operate(self, verb: Verb, scope: str, *, by_hand: bool = False, arguments: Arguments = ()) -> Future:
        self.acts.append((verb, scope, by_hand, *arguments))
        future: Future = Future()
        if self.unanswered is not None:
            self.unanswered.append(future)
        else:
            answer = OperatorAnswer(verb=verb, scope=scope, refusal=self.refusal, **self.told)
            future.set_result(answer if self.unkept is None else stop_left(answer, self.unkept))
        return future

    def act(self, number: int) -> dict | None:
        return self.rows.get(number)

    def watch(self, callback: Callable[[dict], None]) -> Callable[[], None]:
        self.watchers.append(callback)
        return lambda: self.watchers.remove(callback)

    def becomes(self, **keys: Any) -> None:
        """The plant has stepped: it has these keys now, and tells its watchers."""
        self.view = {**self.view, "at": self.view["at"] + 1, **keys}
        for watcher in self.watchers:
            watcher(self.view)


@pytest.fixture
def plant() -> Plant:
    return Plant()


@pytest.fixture
def local(serve: Callable[..., Any]) -> Any:
    """The plant on one's own machine, as the fixture `serve` of a folder serves it."""
    return serve()


@pytest.fixture
def open_to_all(serve: Callable[..., Any]) -> Any:
    """The plant on a network."""
    return serve(dict(TOKENS))


@pytest.fixture
def web(local: Any) -> Any:
    """Somebody at that machine."""
    return local.client()
