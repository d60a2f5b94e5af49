"""Layout of a file: where a node can be put in or taken out so that all other lines stay as they are."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from arboleda_trees.bt_xml.markup import TAG, Element, Span

UNIT = b"  "  # of a file that has no level of its own
BLANKS = b" \t"
TOKEN = re.compile(rb"<!--.*?-->|<\?.*?\?>|<!\[CDATA\[.*?\]\]>|" + TAG.pattern, re.DOTALL)
REST = re.compile(rb"(?:[ \t]*<!--[^\n]*?-->)*[ \t]*(?=\r?\n)")  # of a line: nothing, or comments


@dataclass(frozen=True)
class Splice:
    """Bytes from `start` to `end` with what takes their place."""

    start: int
    end: int
    new: bytes


def spliced(content: bytes, splices: Iterable[Splice]) -> bytes:
    """The content with these splices, none of which overlap."""
    for each in sorted(splices, key=lambda splice: splice.start, reverse=True):
        content = content[: each.start] + each.new + content[each.end :]
    return content


def margin(content: bytes, at: int) -> bytes | None:
    """The blanks before a place, if nothing else stands before it on its line; else None."""
    line = content[content.rfind(b"\n", 0, at) + 1 : at]
    return line if not line.strip(BLANKS) else None


def line_end(content: bytes) -> bytes:
    """The line end of a file: that of its first line."""
    first = content.find(b"\n")
    return b"\r\n" if first > 0 and content[first - 1 : first] == b"\r" else b"\n"


def unit(content: bytes, root: Element) -> bytes:
    """The blanks by which a file indents a level: those of the first node that stands further in."""
    waiting = [root]
    for element in waiting:
        outer = margin(content, element.span.start)
        for child in element.children:
            inner = margin(content, child.span.start)
            if outer is not None and inner is not None and inner.startswith(outer) and inner != outer:
                return inner[len(outer) :]
        waiting += element.children
    return UNIT


def removal(content: bytes, span: Span) -> Splice:
    """The splice that takes an element out, with its line where nothing else stands there."""
    before = margin(content, span.start)
    after = re.compile(rb"[ \t]*(?:\r?\n|\Z)").match(content, span.end)
    if before is None or after is None:
        return Splice(span.start, span.end, b"")
    return Splice(span.start - len(before), after.end(), b"")


def insertion(content: bytes, root: Element, parent: Element, index: int, fragment: bytes) -> Splice:
    """The splice that makes a fragment, written for the margin "", the child `index` of an element."""
    inner = _inner_margin(content, root, parent)
    if parent.span.is_empty:
        return _opening(content, parent, inner, fragment)
    at = parent.children[index - 1].span.end if index else parent.span.head
    rest = REST.match(content, at)
    if rest is None or inner is None:
        return Splice(at, at, fragment)
    return Splice(rest.end(), rest.end(), line_end(content) + inner + indented(fragment, b"", inner))


def indented(fragment: bytes, old: bytes, new: bytes) -> bytes:
    """A fragment whose lines begin with another margin; comments and values of attributes stay."""
    pattern = re.compile(rb"\n" + re.escape(old) + rb"(?![\r\n])")
    found, end = b"", 0
    for token in TOKEN.finditer(fragment):
        found += pattern.sub(b"\n" + new, fragment[end : token.start()]) + token[0]
        end = token.end()
    return found + pattern.sub(b"\n" + new, fragment[end:])


def taken(content: bytes, span: Span) -> bytes:
    """The bytes of an element, for the margin ""."""
    before = margin(content, span.start)
    fragment = content[span.start : span.end]
    return fragment if before is None else indented(fragment, before, b"")


def _inner_margin(content: bytes, root: Element, parent: Element) -> bytes | None:
    """The margin of the children of an element; None where it stands on a line with others."""
    there = (margin(content, child.span.start) for child in parent.children)
    found = next((each for each in there if each is not None), None)
    if found is not None:
        return found
    outer = margin(content, parent.span.start)
    return None if outer is None else outer + unit(content, root)


def _opening(content: bytes, parent: Element, inner: bytes | None, fragment: bytes) -> Splice:
    """The splice that gives an element of one tag a second one, with the fragment between them."""
    end = parent.span.head
    start = parent.span.start + len(content[parent.span.start : end - 2].rstrip())
    closing = f"</{parent.name}>".encode()
    outer = margin(content, parent.span.start)
    if inner is None or outer is None:
        return Splice(start, end, b">" + fragment + closing)
    line = line_end(content)
    return Splice(start, end, b">" + line + inner + indented(fragment, b"", inner) + line + outer + closing)
