"""Snapshots of the plant as messages of a record: a whole one now and then, changes in between."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, takewhile
from typing import Any

import zstandard

from arboleda.model.messages import Report
from arboleda.views.changes import changed
from arboleda.views.chronicle import Chronicle

from .channels import CHANGES, EVENTS, VIEW, Channel
from .motion import Motion
from .plain_data import plain
from .rows import LINKS, Row, Rows, rows_of
from .steps import Step

LOOK_S = 0.25  # between two looks at where robots are
WHOLE_S = 30.0  # a whole view is written so often; a reader reads from one to the next at once
DIGEST_S = 300.0  # at most this part of the time line has to be read from messages
Message = tuple[str, int, bytes]  # topic, ns of Unix time, content


@dataclass(frozen=True)
class ViewSnapshot:
    """Snapshot as screens got it, and the twin's positions of that moment."""

    unix_ns: int
    snapshot: Row
    drawn: Row


class ViewLog:
    """Source of view messages, made of steps and snapshots.

    Times never run back, as clocks on the wall may.
    """

    channels: Sequence[Channel] = ()  # those of each record

    def __init__(self, past_acts: Iterable[Row] = (), links: Callable[[], Mapping[str, Any]] = dict) -> None:
        self._links = links
        self._chronicle = Chronicle(past_acts)
        self._last_event = 0  # number of the last event written
        self._motion = Motion()
        self._rows: Rows = {}
        self._at = self._looked_at = 0.0
        self._ns = self._whole_ns = self._digest_ns = 0
        self._digest: list[str] = []

    def stepped(self, step: Step) -> Iterator[Message | None]:
        """The messages for a step's changes of positions."""
        for event in step.events:
            if isinstance(event, Report):
                self._motion.hear(event)
        if self._rows and not 0.0 <= step.now - self._looked_at < LOOK_S:
            self._looked_at = step.now
            yield from self._news(step.unix_ns, step.now, self._motion.news(step.now))

    def saw(self, snapshot: ViewSnapshot) -> Iterator[Message | None]:
        """The messages for the changes in a snapshot."""
        for robot in snapshot.drawn["robots"]:
            self._motion.take(robot)
        at = snapshot.snapshot["at"]
        links = (LINKS, dict(self._links()))
        rows = chain(rows_of(snapshot.snapshot, snapshot.drawn), self._motion.rows(at), [links])
        yield from self._news(snapshot.unix_ns, at, rows, everything=True)
        self._chronicle.see(snapshot.snapshot, self._ns / 1e9)
        yield from self._events()

    def whole(self) -> Iterator[Message | None]:
        """The whole view so far, for the beginning of a file; empty if there is none yet."""
        if self._rows:
            self._whole_ns = self._ns
            yield from self._message(VIEW, [], self._rows.items())

    def digest(self, *, ends: bool) -> bytes:
        """The events of the time line since the last digest, compressed; empty if no digest is due.

        `ends`: the file ends, so one is due at once.
        """
        if not self._digest or not (ends or self._ns - self._digest_ns >= DIGEST_S * 1e9):
            return b""
        self._digest_ns, text = self._ns, f"[{','.join(self._digest)}]"
        self._digest = []
        return zstandard.compress(text.encode())

    def _news(
        self, unix_ns: int, at: float, rows: Iterable[tuple[str, Row]], *, everything: bool = False
    ) -> Iterator[Message | None]:
        """The message for new rows; `everything`: rows that are not among these are gone."""
        self._ns, self._at = max(self._ns, unix_ns), at
        fields, keys = [], set()
        for key, row in rows:
            before = self._rows.get(key, {})
            keys.add(key)
            if before != row:
                self._rows[key] = row
                fields.append((key, changed(before, row)))
            yield None
        gone = [key for key in self._rows if key not in keys] if everything else []
        for key in gone:
            del self._rows[key]
        if fields or gone:
            yield from self._message(CHANGES, gone, fields)
        if self._ns - self._whole_ns >= WHOLE_S * 1e9:
            yield from self.whole()

    def _message(
        self, topic: str, gone: list[str], rows: Iterable[tuple[str, Row]]
    ) -> Iterator[Message | None]:
        texts = []
        for key, row in rows:
            texts.append(f"{json.dumps(key)}:{_text(row)}")
            yield None
        head = f'"at":{self._at!r}' + (f',"gone":{json.dumps(gone)}' if gone else "")
        yield topic, self._ns, f'{{{head},"rows":{{{",".join(texts)}}}}}'.encode()

    def _events(self) -> Iterator[Message | None]:
        newest = takewhile(lambda event: event["number"] > self._last_event, reversed(self._chronicle.events))
        for event in [*newest][::-1]:
            self._last_event = event["number"]
            text = _text(event)
            self._digest.append(text)
            yield EVENTS, self._ns, text.encode()


def _text(row: Row) -> str:
    return json.dumps(plain(row), separators=(",", ":"))
