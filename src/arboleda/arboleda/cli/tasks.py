"""`arboleda tasks`: every task and its outcome, also of earlier starts."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from datetime import datetime
from enum import Enum
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from arboleda.model.messages import TaskState
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase
from arboleda.store.task_rows import (
    History,
    TaskQuery,
    TaskRow,
    answers_of,
    choice_of,
    sentence_of,
    table,
    unchecked_of,
)

from . import plant_options
from .language import say, word
from .plant_options import RunningPlant, StateFolder, StoreAddress
from .screen import STYLES, answers_line

AGO = re.compile(r"(\d{1,6})\s*([smhdw])")
SECONDS = {"s": 1.0, "m": 60.0, "h": 3600.0, "d": 86_400.0, "w": 604_800.0}
LOOK_S = 0.5  # a file tells nobody that it has changed
HEADINGS = {
    "accepted": Phrase("cli.tasks.accepted", "accepted"),
    "by": Phrase("cli.tasks.by", "by"),
    "id": Phrase("cli.tasks.id", "id"),
    "task": Phrase("cli.tasks.task", "task"),
    "state": Phrase("cli.tasks.state", "state"),
    "tries": Phrase("cli.tasks.tries", "tries"),
    "took": Phrase("cli.tasks.took", "took"),
    "why": Phrase("cli.tasks.why", "why"),
}
ANSWERS = Phrase("cli.tasks.answers", "answers")  # a column, if a task of the list has any
NO_TIME = Phrase(
    "cli.tasks.no_time",
    "'{text}' is no time; write how long ago, as 30m, 2h or 7d, or when, as 2026-11-21T14:30",
)
ONE_FORM = Phrase("cli.tasks.one_form", "choose one of --json and --csv")
NONE_KEPT = Phrase("cli.tasks.none_kept", "no such task was kept")


class KeptState(str, Enum):
    """The states that a kept task can be in."""

    QUEUED = "queued"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"


def moment(text: str | None) -> float | None:
    """A point in time as Unix time: `2h` ago, or `2026-11-21`, `2026-11-21T14:30` of this machine's clock."""
    if text is None:
        return None
    if found := AGO.fullmatch(text.strip()):
        return time.time() - int(found[1]) * SECONDS[found[2]]
    try:
        return datetime.fromisoformat(text.strip()).timestamp()
    except ValueError:
        raise typer.BadParameter(say(NO_TIME(text=text))) from None


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(tasks)


def tasks(
    words: Annotated[
        str, typer.Argument(metavar="WORDS", help="Only tasks with these words in their text or id.")
    ] = "",
    cell: Annotated[str, typer.Option(metavar="CELL", help="Only tasks of this cell.")] = "",
    status: Annotated[KeptState | None, typer.Option(help="Only tasks in this state.")] = None,
    recipe: Annotated[str, typer.Option(metavar="NAME", help="Only tasks of this recipe.")] = "",
    since: Annotated[
        str | None,
        typer.Option(metavar="TIME", help="Accepted since then: 2h (two hours ago), or 2026-11-21T14:30."),
    ] = None,
    until: Annotated[str | None, typer.Option(metavar="TIME", help="Accepted before then.")] = None,
    limit: Annotated[int, typer.Option(metavar="N", min=1, help="At most so many, the last ones.")] = 50,
    as_json: Annotated[bool, typer.Option("--json", help="Print an object per line.")] = False,
    as_csv: Annotated[bool, typer.Option("--csv", help="Print a table for other programs.")] = False,
    follow: Annotated[
        bool, typer.Option("--follow", help="Go on printing what changes, until Ctrl-C.")
    ] = False,
    plant: RunningPlant = None,
    state: StateFolder = None,
    store: StoreAddress = "",
) -> None:
    """List tasks and their outcomes, also of earlier starts, whether the plant runs or not.

    Ended tasks are kept for `history_days` of the plant file, 90 by default.

    Exit status: 0 printed, 1 the plant's memory cannot be read, 2 bad input, 130 Ctrl-C.
    """
    if as_json and as_csv:
        raise typer.BadParameter(say(ONE_FORM()))
    query = TaskQuery(
        cell=cell,
        state=status.value if status else "",
        recipe=recipe,
        words=words,
        since_s=moment(since),
        until_s=moment(until),
        limit=limit,
    )
    history = plant_options.history(plant, state, store)
    show = _json if as_json else _csv if as_csv else _lines if follow else _table
    if not follow:
        show(list(reversed(history.select(query))), first=True)
        return
    for number, rows in enumerate(_changes(history, query)):
        show(rows, first=not number)


def _changes(history: History, query: TaskQuery) -> Iterator[Sequence[TaskRow]]:
    """The tasks, and then again and again those that are new or have changed."""
    known: dict[str, TaskRow] = {}
    while True:
        rows = list(reversed(history.select(query)))
        news = [row for row in rows if known.get(row.id) != row]
        if news or not known:
            yield news
        known = {row.id: row for row in rows}
        time.sleep(LOOK_S)


def _table(rows: Sequence[TaskRow], *, first: bool) -> None:
    console = Console(highlight=False)
    if not rows:
        console.print(say(NONE_KEPT()))
        return
    drawn = Table(box=None, pad_edge=False)
    answered = {"answers": ANSWERS} if any(row.answers for row in rows) else {}
    for name, heading in {**HEADINGS, **answered}.items():
        whole = max(len(plain(row.id)) for row in rows) if name == "id" else None  # it is copied
        drawn.add_column(say(heading()), overflow="fold", min_width=whole)
    for row in rows:
        at, by, id, text, _, took, why, answers = _columns(row)
        state = Text(word("task_state", row.state), style=STYLES[TaskState(row.state)])
        tries, last = str(row.attempts or ""), [Text(answers)] if answered else []
        drawn.add_row(at, Text(by), Text(id), Text(text), state, tries, took, Text(why), *last)
    console.print(drawn)


def _lines(rows: Sequence[TaskRow], *, first: bool) -> None:
    for row in rows:
        print("  ".join(each for each in _columns(row) if each), flush=True)


def _json(rows: Sequence[TaskRow], *, first: bool) -> None:
    for row in rows:
        answers = [vars(each) for each in answers_of(row)]
        parsed = {key: json.loads(text) if text else None for key, text in _json_of(row).items()}
        fields = asdict(row) | parsed | {"answers": answers, "unchecked": unchecked_of(row)}
        print(json.dumps(fields, ensure_ascii=False), flush=True)


def _json_of(row: TaskRow) -> dict[str, str | None]:
    return {"said": row.said, "choice": row.choice, "course": row.course}


def _csv(rows: Sequence[TaskRow], *, first: bool) -> None:
    print(table(rows, names=first), end="", flush=True)


def _columns(row: TaskRow) -> tuple[str, ...]:
    at = datetime.fromtimestamp(row.accepted_s).isoformat(sep=" ", timespec="seconds")
    took = ""
    if row.started_s is not None and row.ended_s is not None:
        took = f"{row.ended_s - row.started_s:.1f} s"
    texts = (plain(each) for each in (word("asked_by", row.asked_by or ""), row.id, row.text))
    why = say(sentence_of(row) if row.sentence else choice_of(row) or "")
    return (
        at,
        *texts,
        word("task_state", row.state),
        took,
        plain(why),
        plain(answers_line(map(vars, answers_of(row)))),
    )
