"""Messages that are heard for a while: the values at each place, and the order in which they came."""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice

from arboleda.drivers import plain
from arboleda_drivers.meaning import SCALARS, UnreadableValue, as_text
from arboleda_drivers.mqtt_mapping.heard import decoded

LONGEST_SHOWN = 48  # characters of a value that are shown
LONGEST_LIST = 8  # items of a list that are looked at
MOST_MESSAGES = 10_000  # of which the order is kept

Place = tuple[str, str]
"""A topic, and a path in its messages; "" for the whole text."""


@dataclass
class Seen:
    """Values that were heard at one place, each once, the last one last; `count` messages had one."""

    values: list[object] = field(default_factory=list)
    count: int = 0
    retained: bool = False

    def take(self, value: object, *, retained: bool) -> None:
        self.count += 1
        self.retained = self.retained or retained
        if value in self.values:
            self.values.remove(value)
        self.values.append(value)

    @property
    def last(self) -> object:
        return self.values[-1]


@dataclass(frozen=True, kw_only=True)
class Message:
    """Message with its values by path, heard `at` s."""

    at: float
    topic: str
    values: Mapping[str, object]
    retained: bool


class Listening:
    """Places of values, in the order in which they were heard first, and the last messages."""

    def __init__(self) -> None:
        self.places: dict[Place, Seen] = {}
        self.messages: deque[Message] = deque(maxlen=MOST_MESSAGES)

    def take(self, topic: str, payload: bytes, *, retained: bool, at: float = 0.0) -> None:
        """Take a message; one that is neither text nor JSON is none of a mapping."""
        try:
            text = decoded(payload).strip()
        except UnreadableValue:
            return
        values = dict(_values(text))
        self.messages.append(Message(at=at, topic=topic, values=values, retained=retained))
        for path, value in values.items():
            if value != "":
                self.places.setdefault((topic, path), Seen()).take(value, retained=retained)

    def lines(self, after: int = 0) -> Iterator[str]:
        """A line for each place after the first ones, with what it has said last."""
        for (topic, path), seen in islice(self.places.items(), after, None):
            said = plain(as_text(seen.last), LONGEST_SHOWN)
            yield f"{topic} {path}".rstrip() + f": {said}{' (retained)' if seen.retained else ''}"

    def rates(self, seconds: float) -> Iterator[str]:
        """A line for each place: how often it has said something in this time."""
        for (topic, path), seen in self.places.items():
            yield f"# {seen.count} in {seconds:.0f} s: {topic} {path}".rstrip()

    def course(self, place: Place) -> Iterator[tuple[float, object]]:
        """The values at a place with their times, without those that repeat the one before."""
        last: object = None
        for message in self.messages:
            if message.topic == place[0] and place[1] in message.values:
                value = message.values[place[1]]
                if value != last:
                    yield message.at, value
                last = value


def _values(text: str) -> Iterator[tuple[str, object]]:
    """The values in a message with their paths: those of JSON, else the whole text."""
    try:
        body = json.loads(text)
    except (ValueError, RecursionError):
        body = None
    if isinstance(body, Mapping):
        yield from _inside("", body)
    else:
        yield "", body if isinstance(body, SCALARS) else text


def _inside(path: str, body: object) -> Iterator[tuple[str, object]]:
    if isinstance(body, Mapping):
        for key, value in body.items():
            if not set(str(key)) & set(".[]"):
                yield from _inside(f"{path}.{key}" if path else str(key), value)
    elif isinstance(body, list):
        for at, value in enumerate(body[:LONGEST_LIST]):
            yield from _inside(f"{path}[{at}]", value)
    elif isinstance(body, SCALARS):
        yield path, body
