"""Channels of a record: their topics, and the types of their messages."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from mcap.writer import Writer

from .steps import SCHEMA as STEP
from .steps import TOPIC as STEPS

VIEW, CHANGES, EVENTS = "/arboleda/view", "/arboleda/view/changes", "/arboleda/events"
SENTENCE = "key, values, and the English for them with a {slot} for each"


def _schema(title: str, about: str, required: str, **properties: Any) -> dict[str, Any]:
    return {
        "title": title,
        "description": about,
        "type": "object",
        "properties": properties,
        "required": required.split(),
    }


AT = {"type": "number", "description": "seconds on the plant's clock"}
ROWS = {
    "type": "object",
    "description": "rows by key, as cells/sis_a, robots/ra1, tree/sis_a/0.2, tasks/lot42, motion/ra1",
    "additionalProperties": {"type": "object"},
}
GONE = {"type": "array", "items": {"type": "string"}, "description": "keys of rows that there are no more"}
SCHEMAS: dict[str, dict[str, Any]] = {
    STEPS: STEP,
    VIEW: _schema("arboleda.View", "All that screens see at one moment.", "at rows", at=AT, rows=ROWS),
    CHANGES: _schema(
        "arboleda.ViewChanges",
        "What of it has changed since the message before: of each row the fields that did.",
        "at rows",
        at=AT,
        gone=GONE,
        rows=ROWS,
    ),
    EVENTS: _schema(
        "arboleda.Event",
        "One line of the time line.",
        "number at kind subject what sentence",
        number={"type": "integer", "description": "from 1, in order"},
        at={"type": "number", "description": "Unix time in s"},
        cell={"type": ["string", "null"]},
        kind={"type": "string", "description": "task, cell, robot, zone, operator, foreign, fault or alarm"},
        subject={"type": "string"},
        what={"type": "string", "description": "the word of the new state"},
        sentence={"type": "object", "description": SENTENCE},
    ),
}


@dataclass(frozen=True)
class Channel:
    """Topic with the encoding and the type of its messages, as MCAP has them."""

    topic: str
    encoding: str
    type: str
    schema_encoding: str
    schema: bytes
    metadata: dict[str, str] = field(default_factory=dict)


def _in_json(topic: str, schema: dict[str, Any]) -> Channel:
    return Channel(topic, "json", schema["title"], "jsonschema", json.dumps(schema).encode())


OURS = tuple(_in_json(topic, schema) for topic, schema in SCHEMAS.items())


def register(writer: Writer, channels: Iterable[Channel]) -> dict[str, int]:
    """Register these channels in a file; returns their numbers by topic."""
    types: dict[str, int] = {}
    found = {}
    for each in channels:
        if each.type not in types:
            types[each.type] = writer.register_schema(each.type, each.schema_encoding, each.schema)
        found[each.topic] = writer.register_channel(
            each.topic, each.encoding, types[each.type], each.metadata
        )
    return found
