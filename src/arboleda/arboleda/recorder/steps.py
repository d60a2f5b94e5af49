"""A step of the core as a message of a record, with the hash of what it did."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import blake2b
from typing import Any

from arboleda.model.messages import Event

from .errors import NoRecord
from .plain_data import event_from, message_from, plain
from .state import State, named

TOPIC = "/arboleda/steps"
SCHEMA_NAME = "arboleda.Step"
SCHEMA = {
    "title": SCHEMA_NAME,
    "description": "One step of the plant: what went in, and what it did.",
    "type": "object",
    "properties": {
        "now": {"type": "number", "description": "seconds on the plant's clock"},
        "events": {"type": "array", "items": {"type": "object"}, "description": "what went in, in order"},
        "messages": {"type": "array", "items": {"type": "object"}, "description": "what came out, in order"},
        "state": {"type": "object", "description": "the plant's counters and one of its cells, by turns"},
        "hash": {"type": "string", "description": "of messages and state"},
    },
    "required": ["now", "events", "messages", "hash"],
}


@dataclass(frozen=True)
class Step:
    """Step as the plant's thread hands it over, of unchanging objects. `unix_ns` is for people only."""

    unix_ns: int
    now: float
    events: Sequence[Event]
    messages: Sequence[Any]
    state: State


@dataclass(frozen=True)
class RecordedStep:
    """Step as it was read; `result` is its messages and state, in the form that is hashed."""

    unix_ns: int
    now: float
    events: tuple[Event, ...]
    result: dict[str, Any]
    hash: str


def outcome(messages: Sequence[Any], state: State) -> dict[str, Any]:
    """The messages and state of a step, as plain data."""
    return {"messages": plain(messages), "state": plain(named(state))}


def hash_of(result: dict[str, Any]) -> str:
    """The hash of a step's result; equal only if every number is equal to the last bit."""
    return _hash(_text(result))


def as_json(step: Step) -> bytes:
    """The record's message for a step."""
    result = _text(outcome(step.messages, step.state))
    head = _text({"now": step.now, "events": plain(step.events)})
    return f'{head[:-1]},{result[1:-1]},"hash":"{_hash(result)}"}}'.encode()


def _text(data: dict[str, Any]) -> str:
    return json.dumps(data, separators=(",", ":"))


def _hash(text: str) -> str:
    return blake2b(text.encode(), digest_size=8).hexdigest()


def from_json(unix_ns: int, data: bytes) -> RecordedStep:
    """The step in a message; raises NoRecord for anything else."""
    try:
        rows = json.loads(data)
        events = tuple(event_from(each) for each in rows["events"])
        messages = [message_from(each) for each in rows["messages"]]
        result = {"messages": messages, "state": rows["state"]}
        hash = str(rows["hash"]) if messages == rows["messages"] else hash_of(result)
        return RecordedStep(unix_ns, float(rows["now"]), events, result, hash)
    except (AttributeError, KeyError, TypeError, ValueError, RecursionError) as error:
        raise NoRecord("it has a step that is not as a plant writes it") from error
