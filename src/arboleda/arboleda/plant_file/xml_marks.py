"""Strict XML: bytes -> tags that know their line and column; document types, and so entities, are refused."""

from __future__ import annotations

from dataclasses import dataclass, field
from xml.parsers import expat

from .yaml_marks import Mark

LARGEST = 1024 * 1024  # bytes of a file
DEEPEST = 30  # levels


@dataclass(frozen=True)
class Tag:
    """An element, where it begins, and what is in it; text between elements is left out."""

    name: str
    attributes: dict[str, str]
    mark: Mark
    children: list[Tag] = field(default_factory=list)

    def all(self, name: str) -> list[Tag]:
        """The children of that name."""
        return [child for child in self.children if child.name == name]

    def first(self, name: str) -> Tag | None:
        """The first child of that name."""
        return next(iter(self.all(name)), None)


class XmlFault(Exception):
    """The bytes cannot be read further: `mark` and a sentence."""

    def __init__(self, mark: Mark, sentence: str) -> None:
        super().__init__(sentence)
        self.mark = mark
        self.sentence = sentence


def parse(raw: bytes) -> Tag:
    """The outermost element; XmlFault if the bytes are no XML of the accepted kind."""
    reader = _TagReader()
    try:
        reader.parser.Parse(raw, True)
    except expat.ExpatError as error:
        fault = f"this is not XML: {expat.ErrorString(error.code)}"
        raise XmlFault(Mark(error.lineno, error.offset + 1), fault) from None
    except (LookupError, ValueError) as error:  # an encoding that nobody knows
        raise XmlFault(reader.mark, f"this is not XML: {error}") from None
    return reader.top.children[0]


class _TagReader:
    def __init__(self) -> None:
        self.top = Tag("", {}, Mark(1, 1))
        self._open = [self.top]
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = lambda _: self._open.pop()
        self.parser.StartDoctypeDeclHandler = self._refuse_doctype

    @property
    def mark(self) -> Mark:
        return Mark(self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1)

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        if len(self._open) > DEEPEST:
            raise XmlFault(self.mark, f"nested deeper than {DEEPEST} levels")
        tag = Tag(name, attributes, self.mark)
        self._open[-1].children.append(tag)
        self._open.append(tag)

    def _refuse_doctype(self, *_: object) -> None:
        raise XmlFault(self.mark, "a document type (<!DOCTYPE ...>) is not allowed; delete it")
