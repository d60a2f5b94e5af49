"""Changes of the plant for readers of whom none can hold it up, and as server-sent events."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from collections.abc import AsyncIterator, Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from typing import Annotated, Any

from fastapi import APIRouter, Header, Request
from fastapi.responses import StreamingResponse
from starlette.exceptions import HTTPException

from arboleda.model.sentence import in_json

from . import limits
from .plant_api import PlantApi, Snapshot

HISTORY, WAITING, PENDING = 200, 256, 64
Row = dict[str, Any]

# list in a snapshot: (kind of event, key that names a row, keys whose change counts)
ROWS = {
    "cells": (
        "cell",
        "name",
        ("state", "task", "step", "queue", "paused", "waiting_for", "not_ready", "held_by", "advice"),
    ),
    "robots": (
        "robot",
        "name",
        (
            "online",
            "holder",
            "obstacle",
            "state",
            "node",
            "homed",
            "latched",
            "effector",
            "piece",
            "facts",
            "answer",
            "boot_id",
        ),
    ),
    "tasks": ("task", "id", ("text", "cell", "state", "reason", "sentence")),
    "zones": ("zone", "zone", ("state", "robot", "waiting")),
}
PLANT = ("plant", "epoch", "ending")
TOLD = ("alarms", "questions")  # in the row of the plant, where packages tell something


@dataclass(frozen=True, kw_only=True)
class Event:
    """Server-sent event."""

    id: str
    text: str


def event(id: str, kind: str, row: Row) -> Event:
    return Event(id=id, text=f"id: {id}\nevent: {kind}\ndata: {json.dumps(row, default=in_json)}\n\n")


def in_one(events: Iterable[Event]) -> str:
    """The text of events that leave together.

    A stop of 100 cells changes 300 rows; to send each of them alone to 100 readers takes seconds.
    """
    return "".join(each.text for each in events)


def changed(before: Snapshot, after: Snapshot) -> list[tuple[str, Row]]:
    """The (kind, row) of each new or changed row; ages and positions do not count."""
    plant = _plant(after)
    found = [] if plant == _plant(before) else [("plant", plant)]
    for where, (kind, name, keys) in ROWS.items():
        known = {row[name]: _facts(row, (name, *keys)) for row in before[where]}
        now = [_facts(row, (name, *keys)) for row in after[where]]
        found += [(kind, row) for row in now if known.get(row[name]) != row]
    return found


def _plant(snapshot: Snapshot) -> Row:
    """The row of the plant itself."""
    return {key: snapshot[key] for key in PLANT} | {key: snapshot[key] for key in TOLD if key in snapshot}


def _facts(row: Row, keys: tuple[str, ...]) -> Row:
    """The row with these keys only; for a task in it, its id."""
    facts = {key: row[key] for key in keys}
    return {key: value["id"] if key == "task" and value else value for key, value in facts.items()}


class Reader:
    """Queue for one client of texts with events; an overflow ends it."""

    def __init__(self) -> None:
        self._queue: deque[str] = deque()
        self._news = asyncio.Event()
        self.dropped = False

    @property
    def waiting(self) -> int:
        return len(self._queue)

    def put(self, text: str) -> None:
        if len(self._queue) >= WAITING:
            self.dropped = True
        else:
            self._queue.append(text)
        self._news.set()

    async def next(self) -> str | None:
        """The next text; None once the reader was too slow."""
        while not self._queue and not self.dropped:
            self._news.clear()
            await self._news.wait()
        return None if self.dropped else self._queue.popleft()


class Changes:
    """Numbered events made of snapshots. All but `_saw` runs in the server's thread."""

    def __init__(self, side: PlantApi) -> None:
        self._side = side
        self._readers: set[Reader] = set()
        self._history: deque[Event] = deque(maxlen=HISTORY)
        self._fresh: deque[Snapshot] = deque(maxlen=PENDING)
        self._loop: asyncio.AbstractEventLoop | None = None
        self._woken = False
        self._number = 0
        self._latest: Snapshot = {}
        self._whole = ""  # the event of the latest snapshot, made for the first who begins with it

    def __len__(self) -> int:
        return len(self._readers)

    def listen(self, last: str = "") -> Reader:
        """A reader that continues after the event `last`; with a snapshot first if that one is forgotten."""
        if self._loop is None:
            self._loop = asyncio.get_running_loop()
            self._side.watch(self._saw)
            self._take(self._side.snapshot())
        reader = Reader()
        if missed := self._missed(last):
            reader.put(missed)
        self._readers.add(reader)
        return reader

    def leave(self, reader: Reader) -> None:
        """Remove a reader; idempotent."""
        self._readers.discard(reader)

    def _missed(self, last: str) -> str:
        """The events after `last`, or the latest snapshot; "" where there is none after it."""
        known = [change.id for change in self._history]
        if last in known:
            return in_one(list(self._history)[known.index(last) + 1 :])
        self._whole = self._whole or event(self._id(), "snapshot", self._latest).text
        return self._whole

    def _take(self, snapshot: Snapshot) -> None:
        self._latest, self._whole = snapshot, ""

    def _saw(self, snapshot: Snapshot) -> None:
        """Take a snapshot in the plant's thread, for the server's thread."""
        self._fresh.append(snapshot)
        if not self._woken and self._loop is not None:
            self._woken = True
            with suppress(RuntimeError):  # the server has ended
                self._loop.call_soon_threadsafe(self._tell)

    def _tell(self) -> None:
        self._woken = False
        while self._fresh:
            snapshot = self._fresh.popleft()
            if snapshot["at"] < self._latest["at"]:
                continue
            self._give([self._numbered(kind, row) for kind, row in changed(self._latest, snapshot)])
            self._take(snapshot)

    def _numbered(self, kind: str, row: Row) -> Event:
        self._number += 1
        return event(self._id(), kind, row)

    def _give(self, news: list[Event]) -> None:
        self._history += news
        text = in_one(news)
        for reader in self._readers if news else ():
            reader.put(text)

    def _id(self) -> str:
        """The id of an event: a number, which starts anew with the plant, and the epoch of that start."""
        return f"{self._latest['epoch']}-{self._number}"


ABOUT: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "A stream. `snapshot` is the whole plant; `plant`, `cell`, `robot`, `task` and "
        "`zone` are each one row of it that changed. With `Last-Event-ID` it goes on after that event, if it "
        "still can. A reader that does not keep up is cut off.",
        "content": {"text/event-stream": {"schema": {"type": "string"}}},
    }
}


def routes(side: PlantApi, most: int) -> APIRouter:
    """`GET /api/events`, for at most so many readers at a time."""
    api = APIRouter(prefix="/api")
    changes = Changes(side)

    @api.get("/events", response_class=StreamingResponse, responses=ABOUT)
    async def events(request: Request, last_event_id: Annotated[str, Header()] = "") -> StreamingResponse:
        """Changes as they happen (server-sent events)."""
        if len(changes) >= most:
            sentence = f"No more than {most} may listen at a time; close one."
            raise HTTPException(503, sentence, {"retry-after": limits.LATER_S})
        lines = tell(changes, last_event_id, request.scope["arboleda.login"].alive)
        return StreamingResponse(lines, media_type="text/event-stream", headers={"x-accel-buffering": "no"})

    return api


async def tell(changes: Changes, last: str, alive: Callable[[], bool]) -> AsyncIterator[str]:
    """Events as text, and a comment after a while without any, until the reader is too slow or logged out."""
    reader = changes.listen(last)
    try:
        while alive():
            try:
                text = await asyncio.wait_for(reader.next(), limits.BEAT_S)
            except asyncio.TimeoutError:
                yield ": still here\n\n"
                continue
            if text is None or not alive():
                return
            yield text
    finally:
        changes.leave(reader)
