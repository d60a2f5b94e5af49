"""Attributes of an element as splices: a value, a name, one more, one less."""

from __future__ import annotations

import re
from collections.abc import Mapping

from arboleda.drivers import quoted
from arboleda_trees.bt_xml.markup import ATTRIBUTE, Element

from .errors import EditError
from .layout import Splice

NAME = re.compile(r"[^\W\d][\w.\-]*")
BEYOND = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # what XML does not have
LONGEST = 10_000  # characters of a value


def check_name(name: str, what: str) -> None:
    """Raises EditError for what cannot be the name of a tag or an attribute."""
    if not NAME.fullmatch(name) or len(name) > 200:
        raise EditError(
            f"{quoted(name)} cannot be {what}; it must be letters, digits and _, and begin with no digit"
        )


def written(value: str, quote: str = '"') -> str:
    """A value as it stands between quotes; raises EditError for letters that XML does not have."""
    if (wrong := BEYOND.search(value)) is not None:
        raise EditError(f"a value cannot have the letter {quoted(wrong[0])}; XML has none")
    if len(value) > LONGEST:
        raise EditError(f"a value may have {LONGEST} letters")
    text = value.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    text = text.replace(quote, "&quot;" if quote == '"' else "&apos;")
    return text.replace("\n", "&#10;").replace("\r", "&#13;").replace("\t", "&#9;")


def tag(name: str, attributes: Mapping[str, str]) -> bytes:
    """An element of one tag."""
    check_name(name, "the name of a node")
    return f"<{name}{_all_written(attributes)}/>".encode()


def change(content: bytes, element: Element, name: str, value: str | None) -> list[Splice]:
    """The splices that give an attribute a value, or take it away; none where it is so already."""
    spans = _spans(content, element)
    there = element.value(name)
    if there == value:
        return []
    if value is None:
        start, end = spans[name]
        start -= len(content[:start]) - len(content[:start].rstrip())
        return [Splice(start, end, b"")]
    if there is not None:
        return [_exchange(content, spans[name], value)]
    check_name(name, "the name of an attribute")
    at = max((end for _, end in spans.values()), default=_name_end(element))
    return [Splice(at, at, _all_written({name: value}).encode())]


def rename(element: Element, name: str) -> list[Splice]:
    """The splices that give an element another name."""
    check_name(name, "the name of a node")
    span, new = element.span, name.encode()
    first = Splice(span.start + 1, _name_end(element), new)
    if span.is_empty:
        return [first]
    return [first, Splice(span.tail + 2, span.tail + 2 + len(element.name.encode()), new)]


def _all_written(attributes: Mapping[str, str]) -> str:
    for name in attributes:
        check_name(name, "the name of an attribute")
    return "".join(f' {name}="{written(value)}"' for name, value in attributes.items())


def _exchange(content: bytes, span: tuple[int, int], value: str) -> Splice:
    """The splice for a value, within the quotes that are there."""
    start, end = span
    quote = content[end - 1 : end]
    opening = content.index(quote, start) + 1
    return Splice(opening, end - 1, written(value, quote.decode()).encode())


def _spans(content: bytes, element: Element) -> dict[str, tuple[int, int]]:
    """The bytes of each attribute, from its name to its second quote."""
    found = ATTRIBUTE.finditer(content, _name_end(element), element.span.head)
    return {match[1].decode(): match.span() for match in found}


def _name_end(element: Element) -> int:
    return element.span.start + 1 + len(element.name.encode())
