"""Messages of VDA 5050 as bytes: their headers, and whether they fit the schema of their version and topic.

The schemas are the structure of those that the standard publishes (MIT); `tools/vda5050-schemas` made them.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from datetime import datetime, timezone
from functools import cache
from importlib.resources import files
from typing import Any

import fastjsonschema

from arboleda.drivers import plain, quoted
from arboleda.extension import ArboledaError

LARGEST = 1_000_000  # bytes of a message
DIGITS = 20  # digits of a whole number
FULL = {"2.0": "2.0.0", "2.1": "2.1.0", "3.0": "3.0.0"}


class SchemaMismatch(ArboledaError):
    """Error: a message does not fit the schema of its topic; the sentence names the place."""


def to_bytes(version: str, topic: str, message: Mapping[str, Any]) -> bytes:
    """A message as bytes to send; raises SchemaMismatch if the standard does not allow it."""
    _check(version, topic, message)
    return json.dumps(message, separators=(",", ":")).encode()


def from_bytes(version: str, topic: str, payload: bytes) -> dict[str, Any]:
    """A received message; raises SchemaMismatch for anything that the standard does not allow."""
    if len(payload) > LARGEST:
        raise SchemaMismatch(f"it has {len(payload)} bytes")
    try:
        body = json.loads(
            payload,
            parse_constant=_refuse,
            parse_float=_finite,
            parse_int=_whole,
            object_pairs_hook=_without_nulls,
        )
    except (ValueError, RecursionError) as error:
        raise SchemaMismatch(plain(f"it is no JSON: {error}")) from error
    _check(version, topic, body)
    assert isinstance(body, dict)
    return body


class Headers:
    """Headers of the messages of one sender; ids count separately for each topic."""

    def __init__(self, version: str, manufacturer: str, serial: str) -> None:
        self._names = {"version": FULL[version], "manufacturer": manufacturer, "serialNumber": serial}
        self._counts: Counter[str] = Counter()

    def __call__(self, topic: str) -> dict[str, Any]:
        number = self._counts[topic]
        self._counts[topic] += 1
        return {"headerId": number % 2**32, "timestamp": timestamp(), **self._names}


def timestamp() -> str:
    """The time of day, as the standard writes it."""
    return datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%f")[:-3] + "Z"


def _check(version: str, topic: str, message: object) -> None:
    try:
        _checks(version)[topic](message)
    except fastjsonschema.JsonSchemaValueException as error:
        raise SchemaMismatch(
            plain(f"{error.message.replace('data.', '', 1)}{_shown(error.value)}")
        ) from error
    assert isinstance(message, Mapping)
    if message["version"].split(".")[:2] != version.split("."):
        raise SchemaMismatch(plain(f"it is of version {message['version']}, not {version}"))


@cache
def _checks(version: str) -> dict[str, Callable[[object], object]]:
    text = (files(__package__) / f"schemas/{version}.json").read_text("utf-8")
    return {topic: fastjsonschema.compile(schema) for topic, schema in json.loads(text).items()}


def _refuse(word: str) -> float:
    raise ValueError(f"{word} is no number")


def _whole(digits: str) -> int:
    if len(digits) > DIGITS:
        raise ValueError("a number is too large")
    return int(digits)


def _finite(digits: str) -> float:
    """A finite number; the schemas count one without a fraction as an integer, however it is written."""
    number = float(digits)
    if not math.isfinite(number):
        raise ValueError("a number is too large")
    return int(number) if number.is_integer() else number


def _without_nulls(pairs: Sequence[tuple[str, Any]]) -> dict[str, Any]:
    """The message without fields that are null, as many vehicles write a field without a value."""
    return {name: value for name, value in pairs if value is not None}


def _shown(value: object) -> str:
    """The value that does not fit, if it is a single one."""
    return "" if isinstance(value, Mapping | list) else f"; it is {quoted(value)}"
