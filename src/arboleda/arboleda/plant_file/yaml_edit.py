"""Edits of a YAML text: one value is set or removed, and every other character stays as it was.

The text itself is cut, so comments, order, alignment and anchors stay. Each new text is read again: an edit
that changed anything else is refused.
"""

from __future__ import annotations

import math
from typing import Any

from arboleda.model.errors import ArboledaError

from .document import Place, dotted
from .yaml_flow import block, flow, key_text
from .yaml_marks import YamlFault, parse, plain_value
from .yaml_spans import EntryKey, Span, Style, spans

BOM = "\ufeff"
ELSEWHERE = "the file refers to it elsewhere (&, *), or writes it in a rare way; change it there"


class EditRefused(ArboledaError):
    """The text cannot be changed so; the sentence names the place."""


def with_value(raw: bytes, place: Place, value: Any) -> bytes:
    """The text with this plain value at a place; mappings that lead to the place are made where they lack.

    EditRefused where a value above the place is no mapping, or where the change would reach other places.
    """
    if not _is_finite(value):
        raise EditRefused(f"{dotted(place)} must have numbers, neither nan nor infinity")
    before = _plain(raw)
    wanted = _set(before, place, place, value)
    return _verified(_text(raw, _cut(raw).set(place, wanted, before)), place, wanted)


def without(raw: bytes, place: Place) -> bytes:
    """The text without the key or entry at a place; EditRefused where there is none."""
    before = _plain(raw)
    wanted = _removed(before, place, place)
    return _verified(_text(raw, _cut(raw).remove(place, wanted)), place, wanted)


def _is_finite(value: Any) -> bool:
    """False for data with nan or infinity."""
    if isinstance(value, dict):
        return all(map(_is_finite, value.values()))
    if isinstance(value, list):
        return all(map(_is_finite, value))
    return not isinstance(value, float) or math.isfinite(value)


def _plain(raw: bytes) -> Any:
    try:
        return plain_value(raw)
    except YamlFault as fault:
        raise EditRefused(f"line {fault.mark.line}: {fault.sentence}") from None


def _cut(raw: bytes) -> _Cut:
    text = raw.decode("utf-8").removeprefix(BOM)
    return _Cut(text, spans(text))


def _text(raw: bytes, text: str) -> bytes:
    return ((BOM if raw.startswith(BOM.encode()) else "") + text).encode("utf-8", "surrogatepass")


def _verified(raw: bytes, place: Place, wanted: Any) -> bytes:
    """The new text, read again; EditRefused where its value is not `wanted`."""
    try:
        root, faults = parse(raw)
    except YamlFault as fault:
        raise EditRefused(f"{dotted(place)}: {fault.sentence}") from None
    if faults or root.value != wanted:
        raise EditRefused(f"{dotted(place)} cannot be changed alone: {ELSEWHERE}")
    return raw


def _set(node: Any, inside: Place, place: Place, value: Any) -> Any:
    """A copy of plain data with a value in it."""
    if not inside:
        return value
    key, *deeper = inside
    if node is None and isinstance(key, str):
        node = {}
    if isinstance(node, dict) and isinstance(key, str):
        return {**node, key: _set(node.get(key), tuple(deeper), place, value)}
    if isinstance(node, list) and isinstance(key, int) and 0 <= key <= len(node):
        inner = _set(node[key] if key < len(node) else None, tuple(deeper), place, value)
        return [*node[:key], inner, *node[key + 1 :]]
    raise EditRefused(f"{dotted(place)}: there is no such place in the file")


def _removed(node: Any, inside: Place, place: Place) -> Any:
    """A copy of plain data without one entry."""
    if not inside:
        raise EditRefused("the whole file cannot be removed")
    key, *deeper = inside
    if isinstance(node, dict) and key in node:
        inner = {key: _removed(node[key], tuple(deeper), place)} if deeper else {}
        return {name: inner.get(name, each) for name, each in node.items() if deeper or name != key}
    if isinstance(node, list) and isinstance(key, int) and 0 <= key < len(node):
        entry = [_removed(node[key], tuple(deeper), place)] if deeper else []
        return [*node[:key], *entry, *node[key + 1 :]]
    raise EditRefused(f"{dotted(place)}: there is nothing to remove")


class _Cut:
    """Cuts one text; each method answers the whole new text."""

    def __init__(self, text: str, root: Span) -> None:
        self.text = text
        self.newline = "\r\n" if "\r\n" in text else "\n"
        self.root = root

    def set(self, place: Place, wanted: Any, before: Any) -> str:
        """The text in which the value at `place` is as in `wanted`; only differences are cut."""
        chain, keys = self._chain(place)
        for key in keys:
            wanted, before = wanted[key], before[key]
        if len(keys) == len(place) or chain[-1].style in (Style.ALIAS, Style.SCALAR):
            return self._replace(chain, keys, wanted, before)
        return self._insert(chain[-1], place[len(keys)], wanted[place[len(keys)]])

    def remove(self, place: Place, wanted: Any) -> str:
        """The text without the entry at `place`."""
        chain, keys = self._chain(place)
        if len(keys) < len(place):  # within an alias, which becomes what it refers to
            for key in keys:
                wanted = wanted[key]
            return self._replace(chain, keys, wanted, None)
        mapping, key = chain[-2], place[-1]
        if len(mapping.entries) == 1:
            empty: Any = [] if mapping.is_list else {}
            return self._replace(chain[:-1], keys[:-1], empty, None)
        return self._without(mapping, key)

    def _chain(self, place: Place) -> tuple[list[Span], Place]:
        """The spans from the top towards a place, as far as they go, and their keys."""
        chain = [self.root]
        for key in place:
            if key not in chain[-1].entries:
                break
            chain.append(chain[-1].entries[key])
        return chain, place[: len(chain) - 1]

    def _replace(self, chain: list[Span], keys: Place, wanted: Any, before: Any) -> str:
        """The text with another value in a span; of two like lists or mappings, only entries that differ."""
        span = chain[-1]
        alike = isinstance(wanted, dict) and isinstance(before, dict) and wanted.keys() == before.keys()
        rows = isinstance(wanted, list) and isinstance(before, list) and len(wanted) == len(before)
        if span.entries and (alike or rows):
            return self._inner(span, wanted, before)
        above = chain[-2] if keys else None
        if span.style is not Style.BLOCK or above is None or keys[-1] not in above.keys:
            space = " " if span.start == span.end else ""  # of an empty value
            return self._put(span.start, span.end, space + flow(wanted))
        colon = self.text.index(":", above.keys[keys[-1]][1]) + 1
        line_end = self._line_end(colon)
        if line_end > span.start:
            return self._put(span.start, span.end, flow(wanted))
        comment = self.text[colon:line_end].rstrip()
        return self._put(colon, span.end, f" {flow(wanted)}{comment}")

    def _inner(self, span: Span, wanted: Any, before: Any) -> str:
        """The text with the entries of a span that differ, from the last to the first."""
        text = self.text
        keys: list[Any] = [key for key in span.entries if wanted[key] != before[key]]
        for key in sorted(keys, key=lambda each: -span.entries[each].start):
            # Cuts go from the last entry to the first, so that the spans of earlier entries stay right.
            cut = _Cut(text, self.root)
            text = cut._replace([span, span.entries[key]], (key,), wanted[key], before[key])
        return text

    def _insert(self, span: Span, key: EntryKey, value: Any) -> str:
        """The text with one more entry behind the others of a list or mapping."""
        entry = flow(value) if span.is_list else f"{key_text(str(key))}: {flow(value)}"
        if span.style is Style.FLOW:
            if not span.entries:
                return self._put(span.end - 1, span.end - 1, entry)
            behind = max(each.end for each in span.entries.values())
            return self._put(behind, behind, f", {entry}")
        at = self._line_end(len(self.text[: span.end].rstrip()))
        first = min(span.entry_start(each) for each in span.entries)
        line = self.text[self._line_start(first) : first]
        if span.is_list:
            return self._put(at, at, f"{self.newline}{line.rpartition('-')[0]}- {entry}")
        padded, indent = f"{key_text(str(key))}:".ljust(self._width(span) - 1), " " * len(line)
        written = block(padded, value, indent, self.newline)
        return self._put(at, at, f"{self.newline}{indent}{written}")

    def _width(self, span: Span) -> int:
        """Characters from key to value where a person has put the values below each other, else 0."""
        starts = {key: start for key, (start, _) in span.keys.items()}
        widths = {span.entries[key].start - start for key, start in starts.items()}
        lengths = {end - start for start, end in span.keys.values()}
        return min(widths) if len(widths) == 1 and len(lengths) > 1 else 0

    def _without(self, span: Span, key: EntryKey) -> str:
        """The text without one of several entries."""
        keys = list(span.entries)
        number, start, end = keys.index(key), span.entry_start(key), span.entries[key].end
        if span.style is Style.FLOW:
            if number:
                return self._put(span.entries[keys[number - 1]].end, end, "")
            return self._put(start, span.entry_start(keys[1]), "")
        line_start = self._line_start(start)
        if self.text[line_start:start].strip(" -" if span.is_list else " "):
            return self._put(start, span.entry_start(keys[1]), "")
        behind = self._line_end(len(self.text[:end].rstrip()))
        return self._put(line_start, min(behind + len(self.newline), len(self.text)), "")

    def _put(self, start: int, end: int, new: str) -> str:
        return self.text[:start] + new + self.text[end:]

    def _line_start(self, at: int) -> int:
        return self.text.rfind("\n", 0, at) + 1

    def _line_end(self, at: int) -> int:
        end = self.text.find(self.newline, at)
        return len(self.text) if end < 0 else end
