"""The tasks: a form that writes the task text, then queue and history."""

from __future__ import annotations

from typing import Any

from .cell_filter import cell_filter
from .plant_side import Layout
from .tags import act_button, link, live, rows, tag
from .trees import zooms
from .wording import Words

COLUMNS = ("state", "text", "started", "ended", "took", "why", "id", "acts")


def build(layout: Layout, words: Words) -> None:
    with tag("form", id="task-form", classes="box form"):
        tag("h2", words("tasks.new"))
        _choices("cell", words("tasks.cell"), [(cell["name"], cell["name"]) for cell in layout["cells"]])
        recipes = [(name, words(f"recipe.{name}")) for name in ("storage", "palletizing")]
        _choices("recipe", words("tasks.recipe"), recipes)
        with tag("div", classes="maps"):
            for cell in layout["cells"]:
                _maps(cell, words)
        _text(words)
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


def _choices(name: str, label: str, choices: list[tuple[str, str]]) -> None:
    with tag("fieldset", classes="choices"):
        tag("legend", label)
        for value, text in choices:
            tag("button", text, type="button", classes="choice", data_choice=name, data_value=value)


def _maps(cell: dict[str, Any], words: Words) -> None:
    """The grid and the rack of one cell."""
    with tag("div", classes="map-pair", data_maps=cell["name"]):
        with tag("fieldset", classes="map"):
            tag("legend", words("tasks.path"))
            _grid(cell, words)
        with tag("fieldset", classes="map"):
            tag("legend", words("tasks.station"))
            _rack(cell, words)
        with tag("div", classes="codes", role="group", aria_label=words("tasks.path")):
            for code, nodes in cell["paths"].items():
                way = "-".join(str(node) for node in nodes)
                tag(
                    "button", code, type="button", classes="choice", data_path=code, data_nodes=way, title=way
                )


def _rack(cell: dict[str, Any], words: Words) -> None:
    with tag("div", classes="rack"):
        for station in range(cell["stations"]):
            label = words("tasks.station_label", station=station)
            number = str(station)
            tag("button", number, type="button", classes="place", data_station=number, aria_label=label)


def _grid(cell: dict[str, Any], words: Words) -> None:
    """A button per node; a click on a start, then on an end, chooses the path between them."""
    rows_, columns = cell["grid"]["rows"], cell["grid"]["columns"]
    ends = {nodes[0]: "start" for nodes in cell["paths"].values()}
    ends |= {nodes[-1]: "end" for nodes in cell["paths"].values()}
    with tag("div", classes="grid", style=f"--columns: {columns}", data_columns=str(columns)):
        tag("div", classes="way", aria_hidden="true")
        for node in range(rows_ * columns):
            kind = ends.get(node, "between")
            label = words(f"tasks.node_{kind}", node=node)
            tag(
                "button",
                str(node),
                type="button",
                classes=f"place {kind}",
                data_node=str(node),
                aria_label=label,
                title=label,
            )


def _text(words: Words) -> None:
    with tag("div", classes="send"):
        with tag("label", classes="text"):
            tag("span", words("tasks.text"))
            tag(
                "input",
                id="task-text",
                type="text",
                autocomplete="off",
                autocapitalize="off",
                spellcheck="false",
                maxlength="200",
                placeholder="sis_a 0B 7",
            )
        act_button(
            words("tasks.send"), "submit", "", words("tasks.send_does"), classes="primary", id="task-send"
        )
    tag("p", words("tasks.send_does"), classes="hint")
