"""Course of one cell in a span of a record."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from arboleda.recorder import plain_data

from .views import Row, Rows, Views

NEEDED = ("state", "task", "tree")  # of a cell's row
AT_ONCE_NS = 60 * 10**9  # of a span no longer than this, every view is read

At = tuple[int, Rows]


@dataclass(frozen=True)
class CellMoment:
    """Cell at a moment at which its tree or its tasks changed: its name, state, task and tree; and its tasks.

    Spans in the tree are moments on the plant's clock.
    """

    unix_ns: int
    cell: Row
    tasks: list[Row]


def followed(views: Views, cell: str, after_ns: int, until_ns: int) -> Iterator[CellMoment]:
    """The changes of a cell in that time, in order.

    Where a long time begins and ends with the same rows, nothing is looked for in between: each has the
    moment at which it last changed.
    """
    first = {} if after_ns < views.began_ns else _of(views.rows(after_ns), cell)
    yield from _between(views, cell, (after_ns, first), (until_ns, _of(views.rows(until_ns), cell)))


def _between(views: Views, cell: str, first: At, last: At) -> Iterator[CellMoment]:
    """The changes between `first` and `last`, the ends of a span, each with its rows."""
    (after_ns, before), (until_ns, after) = first, last
    if until_ns - after_ns <= AT_ONCE_NS:
        yield from _changes(views, cell, first, until_ns)
    elif before != after:
        middle_ns = (after_ns + until_ns) // 2
        middle = (middle_ns, _of(views.rows(middle_ns), cell))
        yield from _between(views, cell, first, middle)
        yield from _between(views, cell, middle, last)


def _changes(views: Views, cell: str, first: At, until_ns: int) -> Iterator[CellMoment]:
    after_ns, known = first[0], dict(first[1])
    made = {key: plain_data.value_from(row) for key, row in known.items()}
    for change in views.changes(after_ns, until_ns):
        news = {key: {**known.get(key, {}), **row} for key, row in _of(change.rows, cell).items()}
        news = {key: row for key, row in news.items() if known.get(key) != row}
        gone = [key for key in change.gone if key in known]
        for key in gone:
            del known[key], made[key]
        known.update(news)
        made.update({key: plain_data.value_from(row) for key, row in news.items()})
        if news or gone:
            yield _looked(change.unix_ns, made, cell)


def _looked(unix_ns: int, made: Rows, cell: str) -> CellMoment:
    row = made[f"cells/{cell}"]
    tree = [made[f"tree/{cell}/{path}"] for path in row["tree"]]
    tasks = [each for key, each in made.items() if key.startswith("tasks/") and each["cell"] == cell]
    task = next((each for each in tasks if each["id"] == row["task"]), None)
    return CellMoment(unix_ns, {"name": cell, "state": row["state"], "task": task, "tree": tree}, tasks)


def _of(rows: Rows, cell: str) -> Rows:
    """The rows that the cell's tree depends on, and the needed part of its own row."""
    mine = (f"tree/{cell}/", "tasks/")
    found = {key: row for key, row in rows.items() if key.startswith(mine)}
    own = rows.get(f"cells/{cell}", {})
    needed = {name: own[name] for name in NEEDED if name in own}
    return {**found, f"cells/{cell}": needed} if needed else found
