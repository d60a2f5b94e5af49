"""One YAML file being read: sections checked one by one, every problem kept with its line and place."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterable
from difflib import get_close_matches
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, TypeAdapter, ValidationError

from arboleda.model.errors import ConfigError

from .problems import Problems
from .yaml_marks import Mark, YamlFault, YamlNode, clipped, parse

T = TypeVar("T")
M = TypeVar("M", bound=BaseModel)
Place = tuple[str | int, ...]  # keys and positions from the top of the file; () is the file itself

KINDS = {
    "model_type": "a mapping (key: value)",
    "dict_type": "a mapping (key: value)",
    "list_type": "a list [a, b, ...]",
    "tuple_type": "a list [a, b, ...]",
    "float_type": "a number",
    "finite_number": "a finite number",
    "int_type": "a whole number",
    "bool_type": "true or false",
    "string_type": "text",
}
BOUNDS = {
    "greater_than": ("gt", "more than"),
    "greater_than_equal": ("ge", "at least"),
    "less_than": ("lt", "less than"),
    "less_than_equal": ("le", "at most"),
}


class Document(Problems):
    """Reads one YAML file by sections; ConfigError at once if nothing in the file can be read.

    `name` is the file's name for people. `folder` has the files that this one names; None for a content that
    lies in no folder. With `runs` a plant of this process runs by the file: its Python is not run again.
    """

    def __init__(self, name: str, raw: bytes, folder: Path | None = None, *, runs: bool = False) -> None:
        super().__init__(name)
        self.folder = folder
        self.runs = runs
        self.files: dict[Path, bytes] = {}  # all files that were read, this one included
        try:
            self._root, faults = parse(raw)
        except YamlFault as fault:
            raise ConfigError((self._line(fault.mark.line, fault.mark.column, fault.sentence),)) from None
        for lesser in faults:
            self.keep(lesser.mark, lesser.sentence)

    def problem(self, place: Place, sentence: str, *, at: Place | None = None) -> None:
        """Keep one problem at the line of `place`, or of what is there of it; with `at`, of that key."""
        where = dotted(place)
        mark = self._mark(place) if at is None else self._key_mark(at)
        self.keep(mark, f"{where}: {sentence}" if where else sentence)

    def unknown(self, place: Place, allowed: Iterable[str]) -> None:
        """Keep the problem that the last key of `place` is not one of `known`."""
        word, allowed = str(place[-1]), sorted(allowed)
        sentence = f"the key {shown(word)} is not known{nearest(word, allowed)}; known: {', '.join(allowed)}"
        self.problem(place[:-1], sentence, at=place)

    def has(self, place: Place) -> bool:
        """True if the file has something there, even an empty value."""
        node = self._root
        for key in place:
            if key not in node.children:
                return False
            node = node.children[key]
        return True

    def value(self, place: Place) -> Any:
        """The plain value there; None if there is none."""
        return self._node(place).value if self.has(place) else None

    def keys(self, place: Place) -> tuple[str, ...]:
        """The keys of the mapping there; none if there is no mapping."""
        value = self.value(place)
        return tuple(value) if isinstance(value, dict) else ()

    def read(self, shape: type[M], place: Place = ()) -> M | None:
        """The mapping there in this shape; None where it is absent, or, with its problems kept, unfit."""
        keys = tuple(field.alias or name for name, field in shape.model_fields.items())
        return self._read(shape.model_validate, place, keys)

    def section(self, shape: type[M], place: Place) -> M | None:
        """The mapping there in this shape, with all defaults where it is absent; None as in `read`."""
        return self.read(shape, place) if self.has(place) else shape()

    def read_plain(self, shape: TypeAdapter[T], place: Place) -> T | None:
        """The value there in this shape, for a value whose keys, if any, are free; None as in `read`."""
        return self._read(shape.validate_python, place, ())

    def _read(self, validate: Callable[[Any], T], place: Place, allowed: tuple[str, ...]) -> T | None:
        if not self.has(place):
            return None
        try:
            return validate(self.value(place))
        except ValidationError as error:
            for fault in error.errors(include_url=False):
                self._fault((*place, *fault["loc"]), fault, allowed)
            return None

    def _fault(self, place: Place, fault: Any, allowed: tuple[str, ...]) -> None:
        key = str(place[-1]) if place else ""
        if fault["type"] == "extra_forbidden":
            self.unknown(place, allowed)
        elif fault["type"] == "missing":
            self.problem(place[:-1], f'the key "{key}" is missing')
        else:
            self.problem(place, _sentence(fault))

    def _mark(self, place: Place) -> Mark:
        return self._node(place).mark

    def _key_mark(self, place: Place) -> Mark:
        return self._node(place[:-1]).keys.get(place[-1], self._mark(place))

    def _node(self, place: Place) -> YamlNode:
        node = self._root
        for key in place:
            if key not in node.children:
                break
            node = node.children[key]
        return node


def dotted(place: Place) -> str:
    """The place as a person reads it: `cells.sis_a.home.deg[1]`."""
    parts = (f"[{part}]" if isinstance(part, int) else f".{clipped(part)}" for part in place)
    return "".join(parts).lstrip(".")


def shown(value: Any) -> str:
    """The value as a sentence shows it: short, text in quotes."""
    if value is None:
        return "empty"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:.10g}"
    if isinstance(value, dict | list):
        return "a mapping" if isinstance(value, dict) else "a list"
    text = clipped(str(value))
    return f'"{text}"' if isinstance(value, str) else text


def nearest(word: str, words: Iterable[str]) -> str:
    """A hint `; did you mean "..."?`, or nothing."""
    close = closest(word, words)
    return f'; did you mean "{close}"?' if close else ""


def closest(word: str, words: Iterable[str]) -> str | None:
    """The word of these that was probably meant; None where none is near enough."""
    close = get_close_matches(word.lower(), list(words), n=1, cutoff=0.6)
    return close[0] if close else None


def misnamed(word: object, allowed: Collection[str], none: str) -> str:
    """The sentence that a word is none of those allowed; it begins with `none` where no word is allowed."""
    rule = f"must be {choice(allowed)}" if allowed else none
    return f"{rule}, is {shown(word)}{nearest(str(word), allowed)}"


def choice(words: Iterable[str]) -> str:
    """The words as an enumeration: `a, b or c`."""
    *head, tail = words
    return f"{', '.join(head)} or {tail}" if head else tail


def _sentence(fault: Any) -> str:
    kind, value, context = fault["type"], fault["input"], fault.get("ctx", {})
    if kind in KINDS:
        return f"must be {KINDS[kind]}, is {shown(value)}{_unquoted(kind, value)}"
    if kind in BOUNDS:
        key, words = BOUNDS[kind]
        return f"must be {words} {context[key]:g}, is {shown(value)}"
    if kind in ("too_short", "too_long"):
        words = "at least" if kind == "too_short" else "at most"
        bound = context["min_length" if kind == "too_short" else "max_length"]
        return f"must have {words} {bound} {'value' if bound == 1 else 'values'}, has {len(value)}"
    if kind in ("literal_error", "enum"):
        words = context["expected"].replace("'", "")
        hint = nearest(value, re.split(", | or ", words)) if isinstance(value, str) else ""
        return f"must be {words}, is {shown(value)}{hint}"
    return f"{fault['msg']}, is {shown(value)}"


def _unquoted(kind: str, value: Any) -> str:
    if kind not in ("float_type", "int_type") or not isinstance(value, str):
        return ""
    try:
        number = float(value)
    except ValueError:
        return ""
    return f"; write {number:g} without quotes or leading zeros" if math.isfinite(number) else ""
