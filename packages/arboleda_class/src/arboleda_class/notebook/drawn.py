"""Drawings and tables that a notebook shows in place, and a terminal as text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from html import escape
from typing import Any, NamedTuple

from py_trees.behaviour import Behaviour

from arboleda.drawing.folding import folded
from arboleda.drawing.picture import Picture, Word, picture
from arboleda.drawing.svg import svg
from arboleda.drawing.words import outline
from arboleda.extension import Sentence, words
from arboleda.views import tree_view
from arboleda.web.languages import FIRST, texts
from arboleda_class.lessons import said_in
from arboleda_proofs.campaigns.from_above import HEIGHT, WIDTH, Scene, as_svg

TOLD = ("name", "feedback")  # of a row of a tree: sentences of the plant
LINE, CHARACTER, INDENT = 20, 7.4, 8  # px


@dataclass(frozen=True)
class Drawing:
    """Drawing that a notebook shows in place: `svg`, and the same as `text` where nothing can be drawn."""

    svg: str
    text: str

    @classmethod
    def of_tree(cls, tree: Behaviour | Sequence[dict[str, Any]], *, language: str = FIRST) -> Drawing:
        """The drawing of any tree of py_trees, as one of your own; or of its rows."""
        rows = tree_view.rows(tree, 0.0) if isinstance(tree, Behaviour) else tree
        say = partial(_said, language)
        translated = [{**row, **{key: say(row[key] or "") for key in TOLD}} for row in folded(rows)]
        return cls(svg(picture(translated)), outline(translated, statuses=True))

    @classmethod
    def of_words(cls, *lines: str) -> Drawing:
        """The drawing of lines of text."""
        return cls(svg(_lines(lines)), "\n".join(lines))

    @classmethod
    def of_scene(cls, scene: Scene) -> Drawing:
        """The drawing of where devices truly are, from above, and below it what is true of each."""
        lines = [f"{name}: {true}" if true else name for name, true in scene.facts.items()]
        text, floor = _lines(lines), as_svg(scene)
        top = HEIGHT if floor else 0
        size = f'width="{max(text.width, WIDTH):g}" height="{text.height + top:g}"'
        below = f'<g transform="translate(0 {top})">{svg(text)}</g>'
        drawn = f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{PAPER}{floor}{below}</svg>'
        return cls(drawn, "\n".join(lines))

    def _repr_svg_(self) -> str:
        return self.svg

    def __str__(self) -> str:
        return self.text

    __repr__ = __str__


def _said(language: str, text: Sentence | str) -> str:
    """A name of a plant or of a lesson, in a language."""
    said = words(language).say(text)
    return said_in(language, said) if said == str(text) else said


PAPER = '<rect width="100%" height="100%" fill="#ffffff"/>'


class Happening(NamedTuple):
    """Row of a table: s since the beginning, the cell, what it is about, its new state, and a sentence.

    `kind` is task, cell, robot, zone, operator, foreign, step or fault.
    """

    at: float
    cell: str
    kind: str
    subject: str
    what: str
    sentence: str


class Table(list[Happening]):
    """Table of what happened, oldest first: a list of rows that a notebook shows as a table."""

    def __init__(self, rows: Iterable[Happening] = (), *, language: str = FIRST) -> None:
        super().__init__(rows)
        self._language = language

    def _repr_html_(self) -> str:
        heads, *rows = self._cells()
        if not rows:
            return f"<p>{escape(self._nothing)}</p>"
        head = "".join(f"<th>{escape(each)}</th>" for each in heads)
        body = ("".join(f"<td>{escape(each)}</td>" for each in row) for row in rows)
        return f"<table><tr>{head}</tr>{''.join(f'<tr>{row}</tr>' for row in body)}</table>"

    def __repr__(self) -> str:
        rows = self._cells()
        if len(rows) == 1:
            return self._nothing
        widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
        lines = ("  ".join(map(str.ljust, row, widths)) for row in rows)
        return "\n".join(line.rstrip() for line in lines)

    @property
    def _nothing(self) -> str:
        return texts(self._language, "notebook")["nothing"]

    def _cells(self) -> list[list[str]]:
        own = texts(self._language, "notebook")
        heads = [own[key] for key in ("time", "cell", "what", "details")]
        return [heads, *([f"{row.at:.2f} s", row.cell, self._what(row), row.sentence] for row in self)]

    def _what(self, row: Happening) -> str:
        language = words(self._language)
        if row.kind in ("step", "fault"):
            return texts(self._language, "notebook")[row.kind if row.kind == "step" else f"fault_{row.what}"]
        what = (
            language(f"links.{row.what}")
            if row.kind == "robot"
            else language.of(f"{row.kind}_state", row.what)
        )
        return language(f"events.{row.kind}", subject=row.subject, what=what)


def _lines(lines: Sequence[str]) -> Picture:
    """Lines of text, one below the other."""
    shapes = (Word(x=INDENT, y=LINE * (row + 0.5), text=line) for row, line in enumerate(lines))
    width = max((len(line) for line in lines), default=0) * CHARACTER + 2 * INDENT
    return Picture(width=round(width), height=LINE * len(lines), shapes=tuple(shapes))
