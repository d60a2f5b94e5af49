"""Messages of a virtual device: what it has to say, put where its mapping hears it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from typing import Any

from arboleda_drivers.meaning import SCALARS, as_text
from arboleda_drivers.mqtt_mapping.heard import Says, Source
from arboleda_drivers.paths import steps

GROUP = re.compile(r"\((?!\?)[^()]*\)")
Said = tuple[Source, str, object]
"""A source, the path in its messages ("" for the whole of it), and the value there."""


def messages(said: Iterable[Said], device: str) -> Iterator[tuple[str, bytes]]:
    """Topics and payloads that say all this; what is heard on one topic as JSON is in one message."""
    whole: dict[str, Any] = {}
    for source, path, value in said:
        topic = source.named(device).replace("+", device).replace("#", device)
        if path:
            whole[topic] = put(whole.get(topic), steps(path), value)
        else:
            yield topic, _text(source, value).encode()
    for topic, body in whole.items():
        yield topic, json.dumps(body, separators=(",", ":")).encode()


def of_says(says: Says, id: object, why: str = "") -> Iterator[Said]:
    """All that makes a message say it of the command of this id."""
    if says.values or says.path or not says.id:
        yield says, says.path, says.values[0] if says.values else id
    if says.id:
        yield says, says.id, id
    if says.why and why:
        yield says, says.why, why


def _text(source: Source, value: object) -> str:
    text = as_text(value) if isinstance(value, SCALARS) else json.dumps(value)
    if not source.pattern:
        return text
    around = GROUP.split(source.pattern.strip("^$"), maxsplit=1)
    return text.join(re.sub(r"\\(.)", r"\1", part) for part in around)


def put(whole: Any, path: tuple[str | int, ...], value: object) -> Any:
    """A body with a value at a path; what is missing on the way is made."""
    if not path:
        return value
    first, rest = path[0], path[1:]
    if isinstance(first, int):
        items = whole if isinstance(whole, list) else []
        items += [None] * (first + 1 - len(items))
        items[first] = put(items[first], rest, value)
        return items
    body = whole if isinstance(whole, dict) else {}
    body[first] = put(body.get(first), rest, value)
    return body
