"""Messages that are heard: the value in one, and whether one says that something is so."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from arboleda.drivers import DriverError, FactType, Value, plain
from arboleda_drivers.meaning import SCALARS, Meaning, UnreadableValue, is_meant, is_range
from arboleda_drivers.paths import NOTHING, json_at, steps

LONGEST_SHOWN = 80  # characters of a message in a sentence
LONGEST = 65536  # bytes of a message that is read
NAME = re.compile(r"\{(\w+)\}")
REPLY = "{reply}"


@dataclass(frozen=True, kw_only=True)
class Source:
    """Place of a value: a topic, and in its messages a path into JSON, or a pattern whose group is the value.

    Without either the whole text is the value. `{device}` in a topic is the device's name there. The topic
    `{reply}` is where it answers what was sent with `reply`.
    """

    hear: str = ""
    path: str = ""
    pattern: str = ""

    def __post_init__(self) -> None:
        if not is_filter(self.hear):
            raise DriverError(f"hear is {self.hear!r}; write the topic, as stat/lamp/POWER")
        if self.path and self.pattern:
            raise DriverError("has a path and a pattern; keep one of them")
        if self.pattern and _groups(self.pattern) != 1:
            raise DriverError(f"pattern {self.pattern} needs one group in parentheses, which is the value")
        if self.path:
            steps(self.path)

    def raw(self, payload: bytes) -> object:
        """The value in a message; NOTHING where it has none."""
        if self.path:
            return json_at(self.path, parsed(payload))
        text = decoded(payload)
        if not self.pattern:
            return text.strip()
        found = re.search(self.pattern, text)
        return NOTHING if found is None else found[1]

    @property
    def where(self) -> str:
        """The place in words."""
        return f"{self.hear} {self.path or self.pattern}".strip()

    def named(self, device: str) -> str:
        """The topic for a device of that name."""
        return self.hear.replace("{device}", device).replace(REPLY, reply_to(device))

    @property
    def is_reply(self) -> bool:
        """True for what it says in answer to a command, which that answer names."""
        return self.hear == REPLY


@dataclass(frozen=True, kw_only=True)
class Heard(Meaning, Source):
    """Value that is heard, and what it means; `unit` is for people."""

    unit: str = ""

    def __post_init__(self) -> None:
        Source.__post_init__(self)
        Meaning.__post_init__(self)

    def read(self, raw: object, of: FactType) -> Value:
        """The value as that type; raises UnreadableValue if it has no meaning there."""
        ranges = any(isinstance(meant, list) and is_range(meant) for meant in self.words.values())
        if isinstance(raw, str) and (ranges or (of.type is not str and not self.words)):
            raw = _as_written(raw)
        return self.value(raw, of, self.where)


@dataclass(frozen=True, kw_only=True)
class Says(Source):
    """Message that says that something is so: any on its topic, or one whose value `equals` this one.

    `id` is the path of the id or number of the command that it is about; `why`, of the reason that it tells.
    """

    equals: Any = None
    id: str = ""
    why: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        for each in self.values:
            if not isinstance(each, SCALARS):
                raise DriverError("equals needs a value, or a list of values")
        for path in filter(None, (self.id, self.why)):
            steps(path)

    @property
    def values(self) -> Sequence[Any]:
        """The values of which one says it; none where any does."""
        if self.equals is None:
            return ()
        return tuple(self.equals) if isinstance(self.equals, list | tuple) else (self.equals,)

    @property
    def names_command(self) -> bool:
        """True where a message says it of one command."""
        return bool(self.id) or self.is_reply

    def is_said(self, payload: bytes, ids: Sequence[str] = (), about: bytes = b"") -> bool:
        """True for a message that says it of a command with one of these ids."""
        if self.is_reply and about not in map(str.encode, ids):
            return False
        raw = self.raw(payload) if self.path or self.pattern or self.values else ""
        if raw is NOTHING or (self.values and not any(is_meant(raw, each) for each in self.values)):
            return False
        return not self.id or any(is_meant(json_at(self.id, parsed(payload)), id) for id in ids)

    def reason(self, payload: bytes) -> str:
        """The reason that a message tells; "" for none."""
        found = json_at(self.why, parsed(payload)) if self.why else NOTHING
        return "" if found is NOTHING or found is None else str(found)


def reply_to(device: str) -> str:
    """The topic on which a device answers over MQTT 5."""
    return f"arboleda/replies/{device}"


def decoded(payload: bytes) -> str:
    """The text of a message; raises UnreadableValue if it is none."""
    if len(payload) > LONGEST:
        raise UnreadableValue(f"it has {len(payload)} bytes; at most {LONGEST} are read")
    try:
        return payload.decode()
    except UnicodeDecodeError as error:
        raise UnreadableValue("it is no text in UTF-8") from error


@lru_cache(maxsize=64)
def parsed(payload: bytes) -> object:
    """The JSON of a message, as nobody may change; raises UnreadableValue if it is none."""
    try:
        return json.loads(decoded(payload), parse_constant=_refused)
    except (ValueError, RecursionError) as error:
        raise UnreadableValue("it is no JSON") from error


def lack(source: Source, payload: bytes) -> str:
    """The sentence that a message does not have the value of a source, and what it has."""
    where = source.path or source.pattern
    body = parsed(payload) if source.path else None
    has = ", ".join(map(str, body)) if isinstance(body, Mapping) else decoded(payload).strip()
    return f"it has no {where}; it has {plain(has, LONGEST_SHOWN)}"


def is_filter(topic: str) -> bool:
    """True for a topic that can be subscribed to."""
    levels = topic.split("/")
    if not topic or "\0" in topic or "#" in "/".join(levels[:-1]):
        return False
    return all(level in ("+", "#") or not {"+", "#"} & set(level) for level in levels)


def matches(filter: str, topic: str) -> bool:
    """True for a topic that a subscription takes in."""
    wanted, given = filter.split("/"), topic.split("/")
    if wanted[-1] == "#":
        wanted, given = wanted[:-1], given[: len(wanted) - 1]
    return len(wanted) == len(given) and all(
        one in ("+", other) for one, other in zip(wanted, given, strict=True)
    )


def _as_written(text: str) -> object:
    """The number or bool that a text is written for; else the text."""
    try:
        found = json.loads(text.lower())
    except ValueError:
        return text
    return found if isinstance(found, SCALARS) else text


def _refused(word: str) -> float:
    raise ValueError(word)


def _groups(pattern: str) -> int:
    try:
        return re.compile(pattern).groups
    except re.error as error:
        raise DriverError(f"pattern {pattern} is no regular expression: {error}") from error
