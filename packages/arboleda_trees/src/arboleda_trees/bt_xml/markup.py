"""XML as people write it for BehaviorTree.CPP: bytes -> elements and attributes that know their places.

expat decides whether a file is XML. BehaviorTree.CPP accepts more: a raw & or < in an attribute, two hyphens
in a comment, lines before the declaration. So expat gets a copy in which these bytes are written over, which
leaves every place as it is. The values of attributes are read from the file itself.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from xml.parsers import expat

from arboleda.recipes.of_files import Mark

from .findings import XmlFault

LARGEST = 1024 * 1024  # bytes of a file
DEEPEST = 100  # levels
TAG = re.compile(rb"""</?[^\s<>"'/=]+[^<>"']*(?:(?:"[^"]*"|'[^']*')[^<>"']*)*>""")
ATTRIBUTE = re.compile(rb"""([^\s=<>/"']+)\s*=\s*("[^"]*"|'[^']*')""")
RAW_AMPERSAND = re.compile(rb"&(?!(?:amp|lt|gt|quot|apos|#[0-9]{1,7}|#x[0-9a-fA-F]{1,6});)")
RAW = re.compile(RAW_AMPERSAND.pattern + rb"|<")
REFERENCE = re.compile(r"&(amp|lt|gt|quot|apos|#[0-9]{1,7}|#x[0-9a-fA-F]{1,6});")
NAMED = {"amp": "&", "lt": "<", "gt": ">", "quot": '"', "apos": "'"}
HIDDEN = ((b"<!--", b"-->", "a comment"), (b"<?", b"?>", "a declaration"), (b"<![CDATA[", b"]]>", "CDATA"))


@dataclass(frozen=True)
class Attribute:
    """Attribute: its decoded value, and the place of its name."""

    value: str
    mark: Mark


@dataclass(frozen=True)
class Span:
    """Bytes of an element: its first tag from `start` to `head`, its last one from `tail` to `end`.

    An empty element has only one tag, and its `tail` is its `end`.
    """

    start: int
    head: int
    tail: int
    end: int

    @property
    def is_empty(self) -> bool:
        """True if the element is one tag, `<A/>`."""
        return self.head == self.end


@dataclass(frozen=True)
class Element:
    """Element of XML with its attributes and children; text between the tags is left out."""

    name: str
    attributes: dict[str, Attribute]
    mark: Mark
    span: Span
    children: list[Element] = field(default_factory=list)

    def value(self, name: str) -> str | None:
        """The value of an attribute; None if there is none."""
        attribute = self.attributes.get(name)
        return None if attribute is None else attribute.value

    def all(self, name: str) -> list[Element]:
        """The children of that name."""
        return [child for child in self.children if child.name == name]


@dataclass(frozen=True)
class Markup:
    """File that was read; `raw` are the places of letters that only BehaviorTree.CPP accepts."""

    root: Element
    raw: Sequence[tuple[Mark, str]]


def parse(content: bytes) -> Markup:
    """The outermost element; raises XmlFault for bytes that are not accepted as XML."""
    content = content.removeprefix(b"\xef\xbb\xbf")
    lines = _Lines(content)
    try:
        content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise XmlFault(lines.mark(error.start), "is not UTF-8 text; save it as UTF-8") from None
    tamed, ends, raw = _tamed(content, lines)
    reader = _ElementReader(content, lines, ends)
    try:
        reader.parser.Parse(bytes(tamed), True)
    except expat.ExpatError as error:
        raise XmlFault(lines.mark(max(reader.parser.ErrorByteIndex, 0)), _no_xml(error, content)) from None
    return Markup(reader.top.children[0], raw)


def _no_xml(error: expat.ExpatError, content: bytes) -> str:
    hint = "; an XML file begins with a tag" if not content.strip().startswith(b"<") else ""
    return f"this is not XML: {expat.ErrorString(error.code)}{hint}"


class _Lines:
    """Line index of a file, which turns the number of a byte into line and column.

    Places are mostly asked for in their order, so columns are counted from the last place. Else the time
    for a long file on one line would grow by the square of its length.
    """

    def __init__(self, content: bytes) -> None:
        self._content = content
        self._starts = [0, *(match.end() for match in re.finditer(rb"\n", content))]
        self._last = (0, Mark(1, 1))

    def mark(self, index: int) -> Mark:
        line = bisect_right(self._starts, index)
        start, column = self._starts[line - 1], 1
        if self._last[1].line == line and self._last[0] <= index:
            start, column = self._last[0], self._last[1].column
        mark = Mark(line, column + len(self._content[start:index].decode("utf-8", "replace")))
        self._last = (index, mark)
        return mark


def _tamed(content: bytes, lines: _Lines) -> tuple[bytearray, dict[int, int], list[tuple[Mark, str]]]:
    """A copy for expat, the end of each tag, and the letters replaced in attributes."""
    tamed, ends = bytearray(content), dict[int, int]()
    raw: list[tuple[Mark, str]] = []
    end = 0
    while (start := content.find(b"<", end)) >= 0:
        _write_over(tamed, RAW_AMPERSAND, end, start)
        if content.startswith(b"<!DOCTYPE", start):
            sentence = "a document type (<!DOCTYPE ...>), and so any entity, is refused; delete it"
            raise XmlFault(lines.mark(start), sentence)
        hidden = next((each for each in HIDDEN if content.startswith(each[0], start)), None)
        if hidden is not None:
            end = _end_of(content, start, hidden, lines)
            tamed[start:end] = bytes(each if each in b"\r\n" else 32 for each in content[start:end])
            continue
        tag = TAG.match(content, start)
        if tag is None:
            break  # expat names the mistake
        end = ends[start] = tag.end()
        for index, letter in _write_over(tamed, RAW, start + 1, end):
            raw.append((lines.mark(index), letter))
    return tamed, ends, raw


def _end_of(content: bytes, start: int, hidden: tuple[bytes, bytes, str], lines: _Lines) -> int:
    opens, closes, what = hidden
    end = content.find(closes, start + len(opens))
    if end < 0:
        raise XmlFault(lines.mark(start), f"{what} begins here and never ends")
    return end + len(closes)


def _write_over(tamed: bytearray, pattern: re.Pattern[bytes], start: int, end: int) -> list[tuple[int, str]]:
    letters = [(match.start(), chr(match[0][0])) for match in pattern.finditer(bytes(tamed[start:end]))]
    for index, _ in letters:
        tamed[start + index] = ord("_")
    return [(start + index, letter) for index, letter in letters]


class _ElementReader:
    def __init__(self, content: bytes, lines: _Lines, ends: dict[int, int]) -> None:
        self.top = Element("", {}, Mark(1, 1), Span(0, 0, len(content), len(content)))
        self._content = content
        self._lines = lines
        self._ends = ends
        self._open = [self.top]
        self.parser = expat.ParserCreate("utf-8")
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end

    def _start(self, name: str, _: object) -> None:
        start = self.parser.CurrentByteIndex
        mark = self._lines.mark(start)
        if len(self._open) > DEEPEST:
            raise XmlFault(mark, f"nested deeper than {DEEPEST} levels; make a tree of its own of a part")
        head = self._ends[start]  # stands for the end, too, until the last tag comes
        attributes = dict(self._attributes(start, len(name.encode())))
        self._open.append(Element(name, attributes, mark, Span(start, head, head, head)))

    def _end(self, _: str) -> None:
        element = self._open.pop()
        span, tail = element.span, self.parser.CurrentByteIndex
        if tail in self._ends and not self._content.startswith(b"/>", span.head - 2):
            element = replace(element, span=replace(span, tail=tail, end=self._ends[tail]))
        self._open[-1].children.append(element)

    def _attributes(self, start: int, length: int) -> Iterator[tuple[str, Attribute]]:
        for match in ATTRIBUTE.finditer(self._content, start + 1 + length, self._ends[start]):
            value = REFERENCE.sub(_letter, match[2][1:-1].decode("utf-8"))
            yield match[1].decode("utf-8"), Attribute(value, self._lines.mark(match.start()))


def _letter(match: re.Match[str]) -> str:
    name = match[1]
    if not name.startswith("#"):
        return NAMED[name]
    number = int(name[2:], 16) if name[1] == "x" else int(name[1:])
    return chr(number)  # expat has refused all but letters
