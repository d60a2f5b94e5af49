"""Proposal of a mapping, from what is heard of a device for a while."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice

from arboleda.drivers import plain
from arboleda_drivers.meaning import SCALARS, UnreadableValue, as_text, is_number
from arboleda_drivers.mqtt_mapping.heard import decoded

MOST_WORDS = 8  # that a fact may have; more are any text
PRESENCE = re.compile(r"lwt|availab|online|status|connect|alive|presence", re.IGNORECASE)
THERE = ("online", "Online", "ONLINE", "connected", "true", "1")
LONGEST_SHOWN = 48  # characters of a value that are shown


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


class Listening:
    """Places of values, as topic and path, in the order in which they were heard."""

    def __init__(self) -> None:
        self.places: dict[tuple[str, str], Seen] = {}

    def take(self, topic: str, payload: bytes, *, retained: bool) -> None:
        """Take a message; one that is neither text nor JSON is none of a mapping."""
        try:
            text = decoded(payload).strip()
        except UnreadableValue:
            return
        for path, value in _values(text):
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

    def proposal(self) -> Iterator[str]:
        """The lines of a kind and of a mapping with all that was heard, to be put into a plant file."""
        facts = {
            (topic, path): seen for (topic, path), seen in self.places.items() if not _is_there(topic, seen)
        }
        names = _names(facts)
        yield "kinds:"
        yield "  thing:"
        yield "    facts:"
        yield from (f"      {names[place]}: {_type(seen)}" for place, seen in facts.items())
        yield "    verbs: {}  # say what it can do"
        yield "# and of the device:"
        yield "driver:"
        yield "  mqtt:"
        yield from self._presence()
        yield "    facts:"
        for (topic, path), seen in facts.items():
            at = f", path: {_quoted(path)}" if path else ""
            yield f"      {names[topic, path]}: {{hear: {_quoted(topic)}{at}{_words(seen)}}}"
        yield "    verbs: {}  # say what is sent for each"

    def _presence(self) -> Iterator[str]:
        for (topic, path), seen in self.places.items():
            if _is_there(topic, seen):
                at = f", path: {_quoted(path)}" if path else ""
                equals = _quoted(_says_there(seen) or "")
                yield f"    online: {{hear: {_quoted(topic)}{at}, equals: {equals}}}"
                return
        yield "    silent_after_s: 30  # nothing was heard that says whether it is there"


def _values(text: str) -> Iterator[tuple[str, object]]:
    """The values in a message with their paths: those of JSON, else the whole text."""
    try:
        body = json.loads(text)
    except (ValueError, RecursionError):
        body = None
    if isinstance(body, Mapping):
        yield from _inside("", body)
    elif text:
        yield "", body if isinstance(body, SCALARS) else text


def _inside(path: str, body: object) -> Iterator[tuple[str, object]]:
    if isinstance(body, Mapping):
        for key, value in body.items():
            if not set(str(key)) & set(".[]"):
                yield from _inside(f"{path}.{key}" if path else str(key), value)
    elif isinstance(body, list):
        for at, value in enumerate(body[:MOST_WORDS]):
            yield from _inside(f"{path}[{at}]", value)
    elif isinstance(body, SCALARS):
        yield path, body


def _is_there(topic: str, seen: Seen) -> bool:
    """True where a device seems to say that it is there."""
    return bool(PRESENCE.search(topic)) and seen.retained and _says_there(seen) is not None


def _says_there(seen: Seen) -> str | None:
    """The word by which it says that it is there; None for none."""
    return next((word for word in map(as_text, seen.values) if word in THERE), None)


def _names(places: Mapping[tuple[str, str], Seen]) -> dict[tuple[str, str], str]:
    """A name for the fact at each place: its last word, with those before it where two would be alike."""
    words = {place: _words_of(*place) for place in places}
    names: dict[tuple[str, str], str] = {}
    for place, found in words.items():
        for length in range(1, len(found) + 1):
            name = "_".join(found[-length:])
            if sum(other[-length:] == found[-length:] for other in words.values()) == 1:
                break
        names[place] = name if name[:1].isalpha() else f"value_{name}"
    return names


def _words_of(topic: str, path: str) -> list[str]:
    return [word.lower() for word in re.findall(r"[A-Za-z0-9]+", f"{topic}/{path}")]


def _type(seen: Seen) -> str:
    if all(isinstance(value, bool) for value in seen.values):
        return "bool"
    if all(is_number(value) for value in seen.values):
        return "int" if all(isinstance(value, int) for value in seen.values) else "number"
    words = [_word(value) for value in seen.values]
    return f"[{', '.join(words)}]" if len(set(words)) == len(words) <= MOST_WORDS else "text"


def _words(seen: Seen) -> str:
    if not _type(seen).startswith("["):
        return ""
    words = ", ".join(f"{_word(value)}: {_quoted(as_text(value))}" for value in seen.values)
    return f", words: {{{words}}}"


def _word(value: object) -> str:
    return "_".join(re.findall(r"[a-z0-9]+", as_text(value).lower())) or "none"


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
