"""Strict YAML: bytes -> nodes that know their line and column; no text is read as another type.

Plain `true`/`false`, decimal numbers and empty values are themselves, as in YAML 1.2; every other
scalar (`on`, `yes`, `012`, `12:30`) is text. Keys are always text. Anchors are read; tags, merge keys,
duplicate keys and a second document are refused.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import yaml

from arboleda.model.outside import plain

LARGEST = 256 * 1024  # bytes of a file
MOST_VALUES = 50_000  # values after aliases are followed
MOST_REPEATED = 5_000  # values by aliases: a short file could have millions, and a check looks at each
LETTERS = 100  # so many letters of a text or a key count as one more value
DEEPEST = 20  # levels
LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

WORDS = {"": None, "~": None, "null": None, "true": True, "false": False}
INTEGER = re.compile(r"[-+]?(0|[1-9][0-9]{0,17})", re.ASCII)
NUMBER = re.compile(
    r"[-+]?((0|[1-9][0-9]*)(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?|[-+]?\.inf|\.nan", re.ASCII
)
CONTROL = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
INDENTING_TAB = re.compile(r"^ *\t", re.MULTILINE)


@dataclass(frozen=True)
class Mark:
    """A place in the file, both counted from 1."""

    line: int
    column: int


@dataclass(frozen=True)
class YamlNode:
    """A value, where it stands, and its children by key (text) or position."""

    value: Any
    mark: Mark
    children: dict[str | int, YamlNode] = field(default_factory=dict)
    keys: dict[str | int, Mark] = field(default_factory=dict)
    size: int = 1


class YamlFault(Exception):
    """The bytes cannot be read further: `mark` and a sentence."""

    def __init__(self, mark: Mark, sentence: str) -> None:
        super().__init__(sentence)
        self.mark = mark
        self.sentence = sentence


def parse(raw: bytes) -> tuple[YamlNode, list[YamlFault]]:
    """The document and the faults that did not stop the reading; raises the YamlFault that did."""
    text = _text(raw)
    try:
        return _Composer(text).document()
    except yaml.MarkedYAMLError as error:
        raise YamlFault(_mark(error.problem_mark), f"this is not YAML: {_reason(error)}") from None


def plain_value(raw: bytes) -> Any:
    """The document as plain data; raises the first YamlFault."""
    root, faults = parse(raw)
    if faults:
        raise faults[0]
    return root.value


def scalar(text: str) -> bool | int | float | str | None:
    """The value of an unquoted scalar."""
    if text in WORDS:
        return WORDS[text]
    if INTEGER.fullmatch(text):
        return int(text)
    if NUMBER.fullmatch(text):
        return float(text.replace(".inf", "inf").replace(".nan", "nan"))
    return text


def clipped(text: str) -> str:
    """`text` as a sentence can show it: one line, at most 40 characters."""
    return plain(text, 40)


def _text(raw: bytes) -> str:
    if len(raw) > LARGEST:
        raise YamlFault(Mark(1, 1), f"the file is larger than {LARGEST // 1024} KiB; is it a plant file?")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = raw[: error.start].decode("utf-8")
        raise YamlFault(_at(before, len(before)), "the file is not UTF-8 text; save it as UTF-8") from None
    for pattern, sentence in (
        (CONTROL, "the character {!a} is not allowed in a text file"),
        (INDENTING_TAB, "a tab stands before the text; indent with spaces"),
    ):
        if match := pattern.search(text):
            place = match.end() - 1
            raise YamlFault(_at(text, place), sentence.format(text[place]))
    return text


def _at(text: str, place: int) -> Mark:
    return Mark(text.count("\n", 0, place) + 1, place - text.rfind("\n", 0, place))


def _mark(mark: Any) -> Mark:
    return Mark(mark.line + 1, mark.column + 1) if mark else Mark(1, 1)


def _reason(error: yaml.MarkedYAMLError) -> str:
    hints = {
        "mapping values are not allowed": "; look at the indent, or put a text with ': ' in it in quotes",
        "cannot start any token": "; a text that starts with this character needs quotes",
        "unexpected end of stream": "; a quote or bracket is not closed",
        "did not find expected": "; look for a wrong indent or an open bracket on this line or above",
    }
    problem = error.problem or "it breaks off"
    return problem + next((hint for key, hint in hints.items() if key in problem), "")


class _Composer:
    """Builds nodes from the parser's events; recursion is bounded by DEEPEST."""

    def __init__(self, text: str) -> None:
        self.events: Iterator[Any] = yaml.parse(text, Loader=LOADER)
        self.anchors: dict[str, YamlNode] = {}
        self.faults: list[YamlFault] = []
        self.repeated = 0  # values by aliases

    def document(self) -> tuple[YamlNode, list[YamlFault]]:
        next(self.events)
        event = next(self.events)
        if isinstance(event, yaml.StreamEndEvent):
            raise YamlFault(Mark(1, 1), "the file is empty")
        root = self.node(next(self.events), depth=0)
        next(self.events)
        event = next(self.events)
        if not isinstance(event, yaml.StreamEndEvent):
            raise YamlFault(_mark(event.start_mark), "a second document starts here; write one per file")
        return root, self.faults

    def node(self, event: Any, depth: int) -> YamlNode:
        mark = _mark(event.start_mark)
        if isinstance(event, yaml.AliasEvent):
            if event.anchor not in self.anchors:
                raise YamlFault(mark, f"*{event.anchor} is used before &{event.anchor} is complete")
            return self.repeat(event.anchor, mark)
        if depth > DEEPEST:
            raise YamlFault(mark, f"nested deeper than {DEEPEST} levels")
        if event.tag is not None:
            self.faults.append(YamlFault(mark, "a tag (!...) is not allowed; write the plain value"))
        node = self.built(event, mark, depth)
        if node.size > MOST_VALUES:
            raise YamlFault(mark, f"more than {MOST_VALUES} values")
        if event.anchor is not None:
            self.anchors[event.anchor] = node
        return node

    def repeat(self, anchor: str, mark: Mark) -> YamlNode:
        node = self.anchors[anchor]
        self.repeated += node.size
        if self.repeated > MOST_REPEATED:
            raise YamlFault(mark, f"aliases (*{clipped(anchor)}) repeat more than {MOST_REPEATED} values")
        return node

    def built(self, event: Any, mark: Mark, depth: int) -> YamlNode:
        if isinstance(event, yaml.MappingStartEvent):
            return self.mapping(mark, depth)
        if isinstance(event, yaml.SequenceStartEvent):
            return self.sequence(mark, depth)
        value = scalar(event.value) if event.implicit[0] else event.value
        return YamlNode(value, mark, size=1 + len(event.value) // LETTERS)

    def sequence(self, mark: Mark, depth: int) -> YamlNode:
        children: dict[str | int, YamlNode] = {}
        while not isinstance(event := next(self.events), yaml.SequenceEndEvent):
            children[len(children)] = self.node(event, depth + 1)
        value = [child.value for child in children.values()]
        return YamlNode(value, mark, children, size=_size(children))

    def mapping(self, mark: Mark, depth: int) -> YamlNode:
        children: dict[str | int, YamlNode] = {}
        keys: dict[str | int, Mark] = {}
        while not isinstance(event := next(self.events), yaml.MappingEndEvent):
            key = self.key(event)
            child = self.node(next(self.events), depth + 1)
            if key in keys:
                first = f"the first is on line {keys[key].line}"
                self.faults.append(
                    YamlFault(_mark(event.start_mark), f'the key "{clipped(key)}" is there twice; {first}')
                )
                continue
            keys[key], children[key] = _mark(event.start_mark), child
        value = {key: child.value for key, child in children.items()}
        return YamlNode(value, mark, children, keys, size=_size(children))

    def key(self, event: Any) -> str:
        mark = _mark(event.start_mark)
        if not isinstance(event, yaml.ScalarEvent):
            raise YamlFault(mark, "a key is a plain word here, not a list, a mapping or an alias")
        if event.value == "<<" and event.implicit[0]:
            raise YamlFault(
                mark, "merging with << is not supported; write the keys out, or refer to a whole value with *"
            )
        if event.anchor is not None:
            raise YamlFault(mark, "an anchor (&...) belongs to a value, not to a key")
        return str(event.value)


def _size(children: dict[str | int, YamlNode]) -> int:
    keys = sum(len(key) // LETTERS for key in children if isinstance(key, str))
    return 1 + keys + sum(child.size for child in children.values())
