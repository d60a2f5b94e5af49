"""Strict JSON: one small object, every value of exactly the declared kind; else PayloadError."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Collection
from unicodedata import normalize

from arboleda.model.errors import PayloadError
from arboleda.model.facts import Facts, Value
from arboleda.model.outside import quoted

LIMIT_BYTES = 512
UINT32 = 2**32 - 1
LARGEST = 1e9  # of a fact that is a number
LONGEST = 32  # characters of a name, and bytes of a text
LONGEST_WORD = 16  # length of a word for a reason
LONGEST_TOKEN = 12  # of a command: which step of which task it is
TEXT_RULE = (
    f"at most {LONGEST} bytes of printable characters without double quotes and backslashes are allowed, "
    "where an accented letter takes 2 bytes, and one of other scripts up to 4"
)
_NAME = re.compile(r"[A-Za-z0-9_.-]+", re.ASCII)
_TEXT = re.compile(r"[ !#-\[\]-~\u00a1-\ud7ff\ue000-\U0010ffff]*")  # each is as long in JSON as in UTF-8


def read(raw: bytes) -> Fields:
    """The object in `raw`; raises PayloadError, which names the mistake in the bytes."""
    value = parse(raw)
    if not isinstance(value, dict):
        raise PayloadError('the message is not a JSON object, e.g. {"estado": 0}')
    return Fields(value)


def parse(raw: bytes) -> object:
    """The value in `raw`, which is limited to a message's length; raises PayloadError."""
    if len(raw) > LIMIT_BYTES:
        raise PayloadError(f"the message has {len(raw)} bytes; at most {LIMIT_BYTES} are allowed")
    try:
        text = raw.decode("utf-8")
        if text.startswith("\ufeff"):
            raise json.JSONDecodeError("Unexpected UTF-8 BOM (decode using utf-8-sig)", text, 0)
        return _from_json(text)
    except UnicodeDecodeError:
        raise PayloadError("the message is not UTF-8") from None
    except RecursionError:
        raise PayloadError("the message is nested too deeply") from None
    except ValueError as error:
        raise PayloadError(f"the message is not JSON: {error}") from None


def write(values: dict[str, object]) -> bytes:
    """Compact JSON; raises PayloadError beyond the length that `read` allows."""
    raw = to_json(values).encode()
    if len(raw) > LIMIT_BYTES:
        raise PayloadError(f"the message would have {len(raw)} bytes; at most {LIMIT_BYTES} are allowed")
    return raw


def integer(key: str, value: object, top: int = UINT32, bottom: int = 0) -> int:
    """`value` if it is an int within bottom..top; a bool is none. Raises PayloadError otherwise."""
    if type(value) is not int:
        raise PayloadError(f"{key} is {_shown(value)}; an integer is needed")
    if not bottom <= value <= top:
        raise PayloadError(f"{key} is {_shown(value)}; allowed: {bottom} to {top}")
    return value


def number(key: str, value: object, bound: float) -> float:
    """`value` as a finite float within +-bound; a bool or a string is none. Raises PayloadError otherwise."""
    if type(value) not in (int, float):
        raise PayloadError(f"{key} is {_shown(value)}; a number is needed")
    # compared before it becomes a float: an int of 500 digits does not fit one
    if not -bound <= value <= bound:  # type: ignore[operator]
        raise PayloadError(f"{key} is {_shown(value)}; allowed: {-bound:.0f} to {bound:.0f}")
    return float(value)  # type: ignore[arg-type]


def name(key: str, value: object, longest: int = LONGEST) -> str:
    """A name of a verb, fact or fault, chosen by the maker of a board."""
    if not isinstance(value, str) or len(value) > longest or not _NAME.fullmatch(value):
        raise PayloadError(f"{key} is {_shown(value)}; 1 to {longest} of A-Z a-z 0-9 _ . - are needed")
    return value


def fact(key: str, value: object) -> Value:
    """A value of a fact, a parameter or an answer: true, false, a number or a short text of any language.

    The letters need not be printable: boards do not know which are.
    """
    if isinstance(value, bool):
        return value
    if isinstance(value, str):
        if not _TEXT.fullmatch(value) or len(value.encode()) > LONGEST:
            raise PayloadError(f"{key} is {_shown(value)}; {TEXT_RULE}")
        return value
    if isinstance(value, int):
        return integer(key, value, bottom=-UINT32)
    return number(key, value, LARGEST)


def shown_fact(key: str, value: object) -> Value:
    """A value that a device reports and people see: its text is printable, and in NFC like that of kinds."""
    value = fact(key, value)
    if not isinstance(value, str):
        return value
    text = normalize("NFC", value)
    if not text.isprintable():
        raise PayloadError(f"{key} is {_shown(value)}; {TEXT_RULE}")
    return text


def facts(key: str, values: object, value: Callable[[str, object], Value] = fact) -> Facts:
    """An object of named values, each of which `value` reads."""
    if not isinstance(values, dict):
        raise PayloadError(f"{key} is {_shown(values)}; an object is needed")
    return tuple((name(f"a name in {key}", each), value(f"{key}.{each}", values[each])) for each in values)


class Fields:
    """Keys of one object; a getter returns a checked value, or raises PayloadError naming the key."""

    def __init__(self, values: dict[str, object]) -> None:
        self._values = values

    def __contains__(self, key: str) -> bool:
        return key in self._values

    def integer(self, key: str, top: int = UINT32, bottom: int = 0) -> int:
        return integer(key, self._get(key), top, bottom)

    def number(self, key: str, bound: float) -> float:
        return number(key, self._get(key), bound)

    def integers(self, key: str) -> tuple[int, ...]:
        """A list of at least one integer."""
        values = self._get(key)
        if not isinstance(values, list) or not values:
            raise PayloadError(f"{key} is {_shown(values)}; a list of integers is needed")
        return tuple(integer(f"{key}[{index}]", value) for index, value in enumerate(values))

    def word(self, key: str, allowed: Collection[str]) -> str:
        value = self._get(key)
        if not isinstance(value, str) or value not in allowed:
            raise PayloadError(f"{key} is {_shown(value)}; allowed: {', '.join(sorted(allowed))}")
        return value

    def optional(self, key: str, top: int = UINT32) -> int | None:
        """An integer that may be absent; `null` does not count as absent."""
        value = self._values.get(key)
        if type(value) is int and 0 <= value <= top:
            return value
        return integer(key, value, top) if key in self._values else None

    def flag(self, key: str) -> bool | None:
        """A flag of 0 or 1 that may be absent."""
        value = self.optional(key, 1)
        return None if value is None else value == 1

    def name(self, key: str) -> str:
        return name(key, self._get(key))

    def token(self, key: str) -> str | None:
        """The token of a command, which may be absent."""
        return name(key, self._values[key], LONGEST_TOKEN) if key in self._values else None

    def matching(self, key: str, check: Callable[[str, str], str]) -> str:
        """A text that `check`, called with key and text, accepts."""
        value = self._get(key)
        if not isinstance(value, str):
            raise PayloadError(f"{key} is {_shown(value)}; a text is needed")
        return check(key, value)

    def shown_fact(self, key: str) -> Value | None:
        """A value that a device reports, which may be absent."""
        return shown_fact(key, self._values[key]) if key in self._values else None

    def facts(self, key: str, value: Callable[[str, object], Value] = fact) -> Facts | None:
        """An object of named values that may be absent."""
        return facts(key, self._values[key], value) if key in self._values else None

    def named(self, key: str, most: int) -> tuple[tuple[int, str], ...] | None:
        """Up to `most` pairs of a number and a word, `[[12, "atasco"]]`, that may be absent."""
        rows = self._values.get(key)
        if key not in self._values:
            return None
        if not isinstance(rows, list) or not 1 <= len(rows) <= most:
            raise PayloadError(f"{key} is {_shown(rows)}; a list of 1 to {most} pairs is needed")
        return tuple(_pair(f"{key}[{index}]", row) for index, row in enumerate(rows))

    def together(self, first: str, second: str) -> None:
        """Raises PayloadError if only one of two keys is there."""
        if (first in self._values) != (second in self._values):
            here, there = (first, second) if first in self._values else (second, first)
            raise PayloadError(f"{there} is missing: it goes with {here}")

    def refuse(self, whose: str, *keys: str) -> None:
        """Raises PayloadError for a key that `whose` messages cannot have."""
        for key in keys:
            if key in self._values:
                raise PayloadError(f"{key} is {_shown(self._values[key])}; {whose} has none")

    def _get(self, key: str) -> object:
        try:
            return self._values[key]
        except KeyError:
            raise PayloadError(f"{key} is missing") from None


def _pair(key: str, row: object) -> tuple[int, str]:
    if not isinstance(row, list) or len(row) != 2:
        raise PayloadError(f"{key} is {_shown(row)}; a number and a word are needed")
    return integer(key, row[0]), name(key, row[1], LONGEST_WORD)


def _unique(pairs: list[tuple[str, object]]) -> dict[str, object]:
    values = dict(pairs)
    if len(values) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise PayloadError(f"{_shown(twice)} appears twice")
    return values


def _no_constant(name: str) -> object:
    raise PayloadError(f"{name} is not a number that JSON knows")


def _shown(value: object) -> str:
    """The value as a sentence names it; a number too large for a float is "too large"."""
    return "too large" if isinstance(value, float) and not math.isfinite(value) else quoted(value)


_from_json = json.JSONDecoder(object_pairs_hook=_unique, parse_constant=_no_constant).decode
to_json = json.JSONEncoder(separators=(",", ":"), allow_nan=False, ensure_ascii=False).encode
"""Encoder of compact JSON without escapes, which could make it longer than a message may be."""
