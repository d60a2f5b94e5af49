"""Messages that are sent: a topic and a payload, filled with the values of a verb's parameters."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from arboleda.drivers import DriverError, Value
from arboleda.wire.transport import Publication
from arboleda_drivers.meaning import SCALARS, as_text, is_meant

from .heard import NAME, decoded, parsed, reply_to

DEVICE, ID, NUMBER = "device", "id", "number"
OURS = (DEVICE, ID, NUMBER)
"""Names beside the parameters of a verb: the device's name in its topics, and the command's id and number."""

MOST = 1_000_000  # the greatest number of a command; 1 follows it


@dataclass(frozen=True, kw_only=True)
class Sent:
    """Message: `{name}` in it is the parameter of the verb, `{device}` the device's name in its topics.

    A payload with keys or a list is sent as JSON; a text in it that is `{name}` alone is the value itself.
    `{id}` and `{number}`, from 1 to `MOST`, are those of the command. `words` are the values to send in place
    of words. With `reply` it names the topic for an answer.
    """

    topic: str
    payload: Any = ""
    words: dict[str, Any] = field(default_factory=dict)
    qos: int = 0
    retain: bool = False
    reply: bool = False

    def __post_init__(self) -> None:
        if not self.topic or {"+", "#", "\0"} & set(self.topic):
            raise DriverError(f"topic is {self.topic!r}; write the whole topic, as cmnd/lamp/POWER")
        if self.qos not in (0, 1, 2):
            raise DriverError(f"qos is {self.qos}; allowed: 0, 1, 2")
        for word, value in self.words.items():
            if not isinstance(value, SCALARS):
                raise DriverError(f"{word} needs a value to send")

    @property
    def names(self) -> set[str]:
        """The names in it."""
        return {*NAME.findall(self.topic), *NAME.findall(json.dumps(self.payload))}

    def filled(self, values: Mapping[str, Value]) -> Publication:
        """The message with these values."""
        given = {name: self.words.get(as_text(value), value) for name, value in values.items()}
        if isinstance(self.payload, SCALARS):
            payload = _filled(as_text(self.payload), given)
        else:
            payload = json.dumps(_filled_json(self.payload, given), separators=(",", ":"))
        answer = (reply_to(str(given[DEVICE])), str(given.get(ID, "")).encode()) if self.reply else ()
        return Publication(_filled(self.topic, given), payload.encode(), self.qos, self.retain, *answer)

    def values(self, topic: str, payload: bytes) -> dict[str, object] | None:
        """The values with which a message was filled, as they were sent; None for any other message."""
        found: dict[str, object] = {}
        if not _unfilled(self.topic, topic, found):
            return None
        if isinstance(self.payload, SCALARS):
            is_it = _unfilled(as_text(self.payload), decoded(payload), found)
        else:
            is_it = _unfilled_json(self.payload, parsed(payload), found)
        return found if is_it else None


def _filled(text: str, values: Mapping[str, Any]) -> str:
    return NAME.sub(lambda found: as_text(values[found[1]]) if found[1] in values else found[0], text)


def _filled_json(value: Any, values: Mapping[str, Any]) -> Any:
    if isinstance(value, Mapping):
        return {key: _filled_json(each, values) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_filled_json(each, values) for each in value]
    if not isinstance(value, str):
        return value
    alone = NAME.fullmatch(value)
    return values[alone[1]] if alone and alone[1] in values else _filled(value, values)


def _unfilled(template: str, text: str, found: dict[str, object]) -> bool:
    """True for a text that the template makes; its values are put into `found`."""
    parts = NAME.split(template)  # texts and names in turn
    pattern = "".join(re.escape(part) if at % 2 == 0 else "(.+?)" for at, part in enumerate(parts))
    match = re.fullmatch(pattern, text, re.DOTALL)
    if match is None:
        return False
    return all(_agrees(found, name, value) for name, value in zip(parts[1::2], match.groups(), strict=True))


def _unfilled_json(template: Any, value: object, found: dict[str, object]) -> bool:
    if isinstance(template, Mapping):
        return isinstance(value, Mapping) and all(
            key in value and _unfilled_json(each, value[key], found) for key, each in template.items()
        )
    if isinstance(template, list | tuple):
        return (
            isinstance(value, list)
            and len(value) == len(template)
            and all(_unfilled_json(each, one, found) for each, one in zip(template, value, strict=True))
        )
    alone = NAME.fullmatch(template) if isinstance(template, str) else None
    if alone is not None:
        return _agrees(found, alone[1], value)
    if isinstance(template, str):
        return isinstance(value, str) and _unfilled(template, value, found)
    return is_meant(value, template)


def _agrees(found: dict[str, object], name: str, value: object) -> bool:
    """Keep a value; False where the same name has another one."""
    before = found.setdefault(name, value)
    return before is value or is_meant(before, value)
