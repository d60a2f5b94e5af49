"""The tasks: a form that writes the task text, then queue and history."""

from __future__ import annotations

from . import task_form
from .cell_filter import cell_filter
from .plant_side import Layout
from .tags import link, live, rows, tag
from .trees import zooms
from .wording import Words

COLUMNS = ("state", "text", "started", "ended", "took", "why", "id", "acts")


def build(layout: Layout, words: Words) -> None:
    task_form.build(layout, words)
    with tag("div", classes="lists"):
        _one(words)
        with tag("div", classes="box"):
            with tag("div", classes="box-head"):
                tag("h2", words("tasks.list"))
                cell_filter("tasks", layout, words)
            columns = [words(f"column.{name}") for name in COLUMNS]
            rows("tasks", columns, empty=words("tasks.none"), classes="tasks")


def _one(words: Words) -> None:
    """The task that the address names; the script shows it."""
    with tag("article", id="task", classes="box", hidden="true"):
        with tag("div", classes="box-head"):
            live("h2", "task.title")
            live("span", "task.state", classes="pill")
            link(words("task.close"), tab="tasks", classes="act")
        live("p", "task.when", classes="hint")
        live("p", "task.cause", classes="trouble")
        live("p", "task.note", classes="note")
        with tag("div", classes="tree-box"):
            with tag("div", classes="tree-tools"):
                zooms(words)
            tag("div", classes="tree", data_tree="#task", role="tree", aria_label=words("task.tree"))
