"""Spans of a YAML text: the first and last character of each key and each value."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

import yaml

from .yaml_marks import LOADER

EntryKey = str | int


class Style(Enum):
    """Style of a value: on lines of its own, in brackets, as one word or text, or as `*name`."""

    BLOCK = "block"
    FLOW = "flow"
    SCALAR = "scalar"
    ALIAS = "alias"


@dataclass(frozen=True, kw_only=True)
class Span:
    """Value from character `start` to `end`, its anchor included.

    `keys` has the begin and end of each key of a mapping. An alias has no entries: they stand elsewhere.
    """

    start: int
    end: int
    style: Style
    is_list: bool = False
    entries: dict[EntryKey, Span] = field(default_factory=dict)
    keys: dict[EntryKey, tuple[int, int]] = field(default_factory=dict)

    def entry_start(self, key: EntryKey) -> int:
        """The begin of an entry: its key, or its value where it has no key."""
        return self.keys[key][0] if key in self.keys else self.entries[key].start


def spans(text: str) -> Span:
    """The span of the whole of a text that `yaml_marks` reads."""
    events = yaml.parse(text, Loader=LOADER)
    opening = (yaml.StreamStartEvent, yaml.DocumentStartEvent)
    first = next(event for event in events if not isinstance(event, opening))
    return _span(first, events)


def _span(event: Any, events: Iterator[Any]) -> Span:
    start = event.start_mark.index
    if isinstance(event, yaml.SequenceStartEvent):
        return _list(event, events)
    if isinstance(event, yaml.MappingStartEvent):
        return _mapping(event, events)
    style = Style.ALIAS if isinstance(event, yaml.AliasEvent) else Style.SCALAR
    return Span(start=start, end=event.end_mark.index, style=style)


def _list(event: Any, events: Iterator[Any]) -> Span:
    entries: dict[EntryKey, Span] = {}
    while not isinstance(each := next(events), yaml.SequenceEndEvent):
        entries[len(entries)] = _span(each, events)
    return _collection(event, each, entries, {}, is_list=True)


def _mapping(event: Any, events: Iterator[Any]) -> Span:
    entries: dict[EntryKey, Span] = {}
    keys: dict[EntryKey, tuple[int, int]] = {}
    while not isinstance(each := next(events), yaml.MappingEndEvent):
        value = _span(next(events), events)
        if each.value not in keys:  # a key that is there twice is a fault; the first counts
            keys[each.value] = (each.start_mark.index, each.end_mark.index)
            entries[each.value] = value
    return _collection(event, each, entries, keys, is_list=False)


def _collection(
    first: Any,
    last: Any,
    entries: dict[EntryKey, Span],
    keys: dict[EntryKey, tuple[int, int]],
    *,
    is_list: bool,
) -> Span:
    """The span of a list or mapping. In a block it ends with its last entry.

    The parser has the end of a block where the next value begins.
    """
    flow = first.flow_style
    end = last.end_mark.index if flow else max(each.end for each in entries.values())
    style = Style.FLOW if flow else Style.BLOCK
    start = first.start_mark.index
    return Span(start=start, end=end, style=style, is_list=is_list, entries=entries, keys=keys)
