"""Page of a package as data: its tabs, and items that are only looked at: a value, a table, a chart."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from math import isfinite
from typing import Any, Literal

from arboleda.model.outside import quoted
from arboleda.web.access.auth import Role

from ..faces import Face
from ..tags import live, rows, tag
from ..wording import Text
from .acts import Act
from .here import Here, labelled

MOST = 200  # rows of a table, points of a chart
NO_ROWS = "{value} is no list of mappings from column to value"
NO_PAIRS = "{value} is no list of pairs of a label and a number, and no mapping"


class _Looked:
    """Item for everybody who may look."""

    role = Role.VIEWER

    def word(self, package: str) -> str:
        return ""


@dataclass(frozen=True)
class Value(_Looked):
    """Value that the part shows by this name, with its label.

    At the cards of cells it may be a mapping, which has the value of each cell by its name.
    """

    name: str
    label: Text = ""

    def draw(self, here: Here) -> None:
        with tag("p", classes="shown"):
            tag("span", here.say(self.label or self.name))
            live("b", here.name(self.name))

    def face(self, here: Here) -> Face:
        return {f"text/{here.name(self.name)}": [here.text(here.given(self.name)), ""]}


@dataclass(frozen=True)
class Rows(_Looked):
    """Table of the rows that the part shows by this name: a list of mappings from column to value.

    `columns` are those shown, with their labels where they have other ones. `acts` are offered in each row,
    or in a row with `acts` those of these names. Who takes one is told the `id` of the row, or its number
    where it has none. `empty` is said where there are no rows. The first 200 rows are shown.
    """

    name: str
    label: Text = ""
    _: KW_ONLY
    columns: Mapping[str, Text] | Sequence[str]
    acts: Sequence[Act] = ()
    empty: Text = ""

    def draw(self, here: Here) -> None:
        columns = [here.say(label) for label in labelled(self.columns).values()] + [""] * bool(self.acts)
        if self.label:
            tag("h2", here.say(self.label))
        with tag("div", style=f"--columns: repeat({len(columns)}, minmax(0, 1fr))"):
            rows(here.name(self.name), columns, empty=here.say(self.empty), classes="plain")

    def face(self, here: Here) -> Face:
        name, given = here.name(self.name), here.given(self.name) or []
        if not isinstance(given, list) or not all(isinstance(row, Mapping) for row in given):
            raise TypeError(NO_ROWS.format(value=quoted(given)))
        told = {str(row.get("id", n)): row for n, row in enumerate(given[:MOST])}
        found: Face = {f"rows/{name}": [*told]}
        return found | {f"row/{name}/{id}": self._row(here, id, row) for id, row in told.items()}

    def _row(self, here: Here, id: str, row: Mapping[str, Any]) -> dict[str, Any]:
        offered = [act for act in self.acts if "acts" not in row or act.name in row["acts"]]
        return {
            "state": "",
            "cell": "",
            "texts": [here.text(row.get(column)) for column in self.columns],
            **({"acts": [act.offer(here, id) for act in offered]} if self.acts else {}),
        }


@dataclass(frozen=True)
class Chart(_Looked):
    """Chart of the numbers that the part shows by this name: pairs of a label and a number, oldest first.

    They may be a mapping from label to number. `kind` is "line" or "bars". The last 200 are shown.
    """

    name: str
    label: Text = ""
    _: KW_ONLY
    kind: Literal["line", "bars"] = "line"

    def draw(self, here: Here) -> None:
        name = here.name(self.name)
        with tag("figure", classes="chart"):
            tag("figcaption", here.say(self.label or self.name))
            tag("div", classes="plot", data_chart=name, data_kind=self.kind, aria_hidden="true")
            live("p", f"{name}.about", classes="hint")

    def face(self, here: Here) -> Face:
        given = here.given(self.name) or []
        pairs = [*given.items()] if isinstance(given, Mapping) else given
        if not isinstance(pairs, list) or not all(isinstance(each, list | tuple) for each in pairs):
            raise TypeError(NO_PAIRS.format(value=quoted(given)))
        points = [[here.text(label), _number(number)] for label, number in pairs[-MOST:]]
        name = here.name(self.name)
        return {f"chart/{name}": points, f"text/{name}.about": [_about(here, points), ""]}


Item = Value | Rows | Chart | Act
"""Item of a tab, of a card or of the settings: a `Value`, `Rows`, a `Chart` or an `Act`."""


@dataclass(frozen=True)
class Tab:
    """Tab of the header, with its items below each other. `name` stands in the page's address."""

    name: str
    label: Text
    items: Sequence[Item]


@dataclass(frozen=True, kw_only=True)
class Page:
    """Page of a package: tabs, items below the card of each cell, and items among the settings.

    Items are `Value`, `Rows`, `Chart` and `Act`. Several tabs share one place of the header. `script` is a
    module in the folder `assets` beside the module of the page; it exports `start()`. `styles` are names of
    style sheets there. `acts` are asked for by that script alone.
    """

    tabs: Sequence[Tab] = ()
    card: Sequence[Item] = ()
    settings: Sequence[Item] = ()
    acts: Sequence[Act] = ()
    script: str = ""
    styles: Sequence[str] = ()


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise TypeError(f"{quoted(value)} is no number of a chart")
    return value


def _about(here: Here, points: Sequence[Sequence[Any]]) -> str:
    """The same in words, also for whoever cannot see the chart."""
    if not points:
        return here.words("chart.none")
    least, most = (end(points, key=lambda each: each[1]) for end in (min, max))
    named: Iterable[tuple[str, Any]] = (("last", points[-1]), ("least", least), ("most", most))
    return here.words("chart.about", **{key: f"{here.text(n)} ({at})" for key, (at, n) in named})
