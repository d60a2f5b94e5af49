"""Spans of a YAML text: where each key and each value of it begins and ends, to the character."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

import yaml

from .yaml_marks import LOADER

Key = str | int


class Style(Enum):
    """Style of a value: on lines of its own, in brackets, as one word or text, or as `*name`."""

    BLOCK = "block"
    FLOW = "flow"
    SCALAR = "scalar"
    ALIAS = "alias"


@dataclass(frozen=True, kw_only=True)
class Span:
    """Value from character `start` to `end`, its anchor within; `keys` has where the keys of a mapping begin
    and end. An alias has no entries: what it refers to is written elsewhere."""

    start: int
    end: int
    style: Style
    is_list: bool = False
    entries: dict[Key, Span] = field(default_factory=dict)
    keys: dict[Key, tuple[int, int]] = field(default_factory=dict)

    def entry_start(self, key: Key) -> int:
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
    entries: dict[Key, Span] = {}
    while not isinstance(each := next(events), yaml.SequenceEndEvent):
        entries[len(entries)] = _span(each, events)
    return _collection(event, each, entries, {}, is_list=True)


def _mapping(event: Any, events: Iterator[Any]) -> Span:
    entries: dict[Key, Span] = {}
    keys: dict[Key, tuple[int, int]] = {}
    while not isinstance(each := next(events), yaml.MappingEndEvent):
        value = _span(next(events), events)
        if each.value not in keys:  # one that is there twice is a fault, and the first counts
            keys[each.value] = (each.start_mark.index, each.end_mark.index)
            entries[each.value] = value
    return _collection(event, each, entries, keys, is_list=False)


def _collection(
    first: Any, last: Any, entries: dict[Key, Span], keys: dict[Key, tuple[int, int]], *, is_list: bool
) -> Span:
    """A list or mapping; one in a block ends with its last entry, not where the next thing begins."""
    flow = first.flow_style
    end = last.end_mark.index if flow else max(each.end for each in entries.values())
    style = Style.FLOW if flow else Style.BLOCK
    start = first.start_mark.index
    return Span(start=start, end=end, style=style, is_list=is_list, entries=entries, keys=keys)
