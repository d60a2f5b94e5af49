"""Trace of a run: everything that happened as one hash and, for people, line by line."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import fields, replace
from functools import cache
from hashlib import blake2b
from typing import Any

from arboleda.model.messages import Heartbeat, OperatorRequest, TaskChanged, TaskRequest
from arboleda.model.verbs import as_text
from arboleda.rig.disk import is_step
from arboleda.rig.world import World
from arboleda.wire.hop import shown

KEPT = 2000  # lines
DECLARED = "definition"  # of a verb, which stands in the plant file
QUIET = ("latido", "sensores")  # channels that speak all the time: hashed, but no news for people


class Trace:
    """Everything that crossed a border in a world; two runs with equal digests did the same.

    `keep`: also remember the last lines; `tell`: also called with each line as it happens.
    """

    def __init__(
        self, world: World, *, keep: bool = False, tell: Callable[[str], None] | None = None
    ) -> None:
        self._world = world
        self._start = world.now
        self._hash = blake2b(digest_size=16)
        self._lines: deque[str] | None = deque(maxlen=KEPT) if keep else None
        self._tell = tell

    @property
    def digest(self) -> str:
        return self._hash.hexdigest()

    @property
    def lines(self) -> list[str]:
        """The last things that happened, oldest first."""
        return list(self._lines or ())

    def look(self) -> None:
        """Take in what happened in this step."""
        moment = self._world.moment
        words = [self._world.now.hex().encode()]
        for client, publication in moment.published:
            words += (_head(client, publication.topic, publication.retain), publication.payload)
        if moment.last_words or moment.unkept:
            unheard = (*moment.last_words, *moment.unkept)
            words += [_hashed(message) for message in unheard if not is_step(message)]
        if moment.sent or moment.requests:
            words += [
                _hashed(message) for message in (*moment.sent, *moment.requests) if not is_step(message)
            ]
        self._hash.update(b"".join(words))
        if self._lines is not None or self._tell is not None:
            for line in self._news():
                self.note(line)

    def note(self, line: str) -> None:
        """Add a line for people, with its time."""
        stamped = f"{self._world.now - self._start:10.3f}  {line}"
        if self._lines is not None:
            self._lines.append(stamped)
        if self._tell is not None:
            self._tell(stamped)

    def _news(self) -> list[str]:
        moment = self._world.moment
        final = (*moment.last_words, *moment.unkept)
        last = [f"last words {_last(each)}" for each in final if not isinstance(each, Heartbeat)]
        requests = [f"asked      {_request_text(event)}" for event in moment.requests]
        messages = [each for each in moment.sent if not is_step(each) and not isinstance(each, Heartbeat)]
        sent = [f"plant      {_sent(each)}" for each in messages]
        published = [
            f"{client or 'stranger':<10} {each.topic} {each.payload.decode(errors='replace')[:200]}"
            for client, each in moment.published
            if not each.topic.endswith(QUIET)
        ]
        others = [
            f"{each.sender:<10} {shown(each.message)} to {each.message.robot}, without an id"
            for each in moment.taken
            if each.sender and not isinstance(each.message, Heartbeat)
        ]
        done = [f"{board:<10} carries out {_fields(goal)}" for board, goal in moment.executed]
        return [*last, *requests, *sent, *others, *published, *done]


@cache
def _head(client: str, topic: str, retain: bool) -> bytes:
    return f"{client}>{topic}{retain}".encode()


def _hashed(message: Any) -> bytes:
    """The message as it is hashed: arguments of a verb as words of its scope."""
    if getattr(message, "arguments", ()):
        message = replace(message, scope=as_text(message.verb, message.scope, message.arguments))
    return repr(message).encode()


def _request_text(event: Any) -> str:
    if isinstance(event, TaskRequest):
        return repr(event.text)
    if isinstance(event, OperatorRequest):
        scope = as_text(event.verb, event.scope, event.arguments)
        return f"{event.verb.value} {scope}{' by hand' if event.by_hand else ''}"
    return _fields(event)


def _last(message: Any) -> str:
    if isinstance(message, TaskRequest | OperatorRequest):
        return f"asked {_request_text(message)}"
    return _sent(message)


def _sent(message: Any) -> str:
    if isinstance(message, TaskChanged):
        why = f" ({message.reason.value})" if message.reason else ""
        return f"task {message.task} {message.text}: {message.state.value}{why} {message.sentence}"
    return _fields(message)


def _fields(message: Any) -> str:
    values = ((each.name, getattr(message, each.name)) for each in fields(message) if each.name != DECLARED)
    told = [f"{name}={_plain(value)}" for name, value in values if value not in (None, ())]
    return " ".join([type(message).__name__, *told])


def _plain(value: Any) -> Any:
    """A value as people read it: `to=open,speed_mm_s=400` for the arguments of a verb."""
    if isinstance(value, tuple) and all(isinstance(each, tuple) and len(each) == 2 for each in value):
        return ",".join(f"{name}={_plain(each)}" for name, each in value)
    return getattr(value, "value", value)
