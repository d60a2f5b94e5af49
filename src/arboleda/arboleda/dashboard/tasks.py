"""The tasks: a form that writes the task text, then queue and history."""

from __future__ import annotations

from . import task_form
from .cell_filter import cell_filter
from .page_api import Layout
from .page_part import Place, Put, put_nothing
from .tags import link, live, rows, tag, way
from .trees import answers_table, zooms
from .wording import Words

KEPT = ("state", "text", "accepted", "asked_by", "ended", "took", "attempts", "why", "id")
COLUMNS = ("state", "text", "started", "ended", "took", "why", "id", "acts")


def build(layout: Layout, words: Words, put: Put = put_nothing) -> None:
    task_form.build(layout, words)
    with tag("div", classes="lists"):
        _one(layout, words, put)
        _list(layout, words, COLUMNS)
        put(Place.TASKS)
        _history(words)


def of_start(layout: Layout, words: Words) -> None:
    """Draw the form, and the tasks of this start alone, for whom nothing is kept beyond it."""
    task_form.build(layout, words)
    with tag("div", classes="lists"):
        _one(layout, words)
        _list(layout, words, COLUMNS)


def of_record(layout: Layout, words: Words) -> None:
    """Draw queue and history of a record."""
    with tag("div", classes="lists"):
        _one(layout, words)
        _list(layout, words, COLUMNS[:-1])


def _list(layout: Layout, words: Words, names: tuple[str, ...]) -> None:
    with tag("div", classes="box"):
        with tag("div", classes="box-head"):
            tag("h2", words("tasks.list"))
            cell_filter("tasks", layout, words)
        columns = [words(f"column.{name}") for name in names]
        rows("tasks", columns, empty=words("tasks.none"), classes="tasks")


def _history(words: Words) -> None:
    """Draw the table of the tasks of all starts; the script fills it once it is looked at."""
    with tag("div", classes="box"):
        with tag("div", classes="box-head"):
            tag("h2", words("history.title"))
            with tag("label", classes="search"):
                tag("span", words("history.search"))
                tag("input", id="history-words", type="search", autocomplete="off", maxlength="100")
        rows(
            "history",
            [words(f"column.{name}") for name in KEPT],
            empty=words("history.none"),
            classes="tasks kept",
        )
        tag("button", words("history.more"), id="history-more", type="button", classes="act", hidden="true")


def _one(layout: Layout, words: Words, put: Put = put_nothing) -> None:
    """Draw the page of the task that the address names; the script fills it."""
    with tag("article", id="task", classes="box", hidden="true"):
        with tag("div", classes="box-head"):
            live("h2", "task.title")
            live("span", "task.state", classes="pill")
            link(words("task.close"), tab="tasks", classes="act")
        live("p", "task.when", classes="hint")
        live("p", "task.cause", classes="trouble")
        answers_table("task.heard", words)
        live("p", "task.choice", classes="hint")
        live("p", "task.note", classes="note")
        if layout.get("recorded"):
            way(None, {"at": "task"}, classes="to-record", data_live="task.record")
        put(Place.TASK)
        with tag("div", classes="tree-box"):
            with tag("div", classes="tree-tools"):
                zooms(words)
            tag("div", classes="tree", data_tree="#task", role="tree", aria_label=words("task.tree"))
