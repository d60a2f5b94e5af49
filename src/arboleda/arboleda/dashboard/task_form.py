"""The form that writes a task's text: a cell, a recipe, and a control for each parameter of the recipe."""

from __future__ import annotations

import json
from typing import Any

from arboleda.model.text import BETWEEN_CELLS as BETWEEN

from .page_api import Layout
from .tags import act_button, tag
from .wording import Words

FEW = 12  # choices that are shown as buttons; more are a list that opens
Row = dict[str, Any]


def build(layout: Layout, words: Words) -> None:
    cells = [*layout["cells"], *_any_of(layout["cells"])]
    with tag("form", id="task-form", classes="box form"):
        tag("h2", words("tasks.new"))
        with _group(words("tasks.cell")):
            for cell in cells:
                _choice(
                    "cell", cell["name"], words("tasks.any_cell") if BETWEEN in cell["name"] else cell["name"]
                )
        with _group(words("tasks.recipe")):
            for name, there in _recipes(cells).items():
                _choice("recipe", name, words.of("recipe", name), data_cells=" ".join(there))
        for cell in cells:
            for recipe in cell["recipes"]:
                _fields(cell, recipe, words)
        _text(_example(cells), words)


def _any_of(cells: list[Row]) -> list[Row]:
    """The choice of all cells as one, with the recipes that each of them offers with the same parameters."""
    alike = [recipe for recipe in cells[0]["recipes"] if all(_offers(cell, recipe) for cell in cells)]
    if len(cells) < 2 or not alike:
        return []
    return [{**cells[0], "name": BETWEEN.join(cell["name"] for cell in cells), "recipes": alike}]


def _offers(cell: Row, recipe: Row) -> bool:
    return any(
        all(each[key] == recipe[key] for key in ("name", "parameters", "default")) for each in cell["recipes"]
    )


def _recipes(cells: list[Row]) -> dict[str, list[str]]:
    """Every recipe of the plant, and the cells that offer it."""
    found: dict[str, list[str]] = {}
    for cell in cells:
        for recipe in cell["recipes"]:
            found.setdefault(recipe["name"], []).append(cell["name"])
    return found


def _fields(cell: Row, recipe: Row, words: Words) -> None:
    """Draw the fields of one recipe of one cell; the script shows those of the chosen one."""
    head = [cell["name"], *([] if recipe["default"] else [recipe["name"]])]
    names = [each["name"] for each in recipe["parameters"]]
    drawn = any(_is_path(cell, each) or _is_station(cell, each) for each in recipe["parameters"])
    with tag(
        "div",
        classes="fields",
        hidden="true",
        data_fields=cell["name"],
        data_recipe=recipe["name"],
        data_head=json.dumps(head),
        data_parameters=json.dumps(names),
        **({"data_maps": cell["name"]} if drawn else {}),
    ):
        if recipe["about"]:
            tag("p", recipe["about"], classes="hint")
        for parameter in recipe["parameters"]:
            _control(cell, parameter, words)
        for parameter in recipe["parameters"]:
            if _is_path(cell, parameter):
                _codes(cell, parameter, words)


def _is_path(cell: Row, parameter: Row) -> bool:
    """True if a parameter names one of the cell's paths over its grid, which can be shown."""
    return bool(parameter["choices"]) and parameter["choices"] == list(cell.get("paths", ()))


def _is_station(cell: Row, parameter: Row) -> bool:
    """True if a parameter numbers the stations of the cell's rack."""
    return bool(parameter["choices"]) and parameter["choices"] == [str(n) for n in range(cell["stations"])]


def _control(cell: Row, parameter: Row, words: Words) -> None:
    name, label = parameter["name"], _label(parameter, words)
    if _is_path(cell, parameter):
        with _field(name, label, classes="map"):
            _grid(cell, words)
    elif _is_station(cell, parameter):
        with _field(name, label, classes="map"):
            _rack(cell, words)
    elif parameter["type"] != "choice":
        _number(parameter, label, words)
    elif len(parameter["choices"]) <= FEW:
        with _field(name, label, classes="choices"):
            for word in parameter["choices"]:
                tag("button", word, type="button", classes="choice", data_set=word)
    else:
        with _named(parameter, label), tag("select", data_set_from=name):
            tag("option", "", value="")
            for word in parameter["choices"]:
                tag("option", word, value=word)


def _label(parameter: Row, words: Words) -> str:
    """The label of a parameter in the page's words, else in the recipe's."""
    return words.flat.get(f"field.{parameter['name']}") or words.say(parameter["called"]).replace("_", " ")


def _number(parameter: Row, label: str, words: Words) -> None:
    """Draw a number field with its limits; the plant has the last word on them."""
    whole = parameter["type"] == "integer"
    limits = {key: parameter[of] for key, of in (("min", "lower"), ("max", "upper")) if of in parameter}
    caption = label
    if len(limits) == 2:
        caption = words("tasks.between", what=label, **{key: f"{value:g}" for key, value in limits.items()})
    with _named(parameter, caption):
        step = "1" if whole else "any"
        tag("input", type="number", step=step, data_set_from=parameter["name"], **limits)


def _named(parameter: Row, label: str) -> Any:
    """Draw a label around one control."""
    made = tag("label", classes="field", data_parameter=parameter["name"])
    with made:
        tag("span", label)
    return made


def _field(name: str, label: str, *, classes: str) -> Any:
    """Draw a group of buttons, of which one is the parameter's value."""
    made = tag("fieldset", classes=classes, data_parameter=name)
    with made:
        tag("legend", label)
    return made


def _group(label: str) -> Any:
    made = tag("fieldset", classes="choices")
    with made:
        tag("legend", label)
    return made


def _choice(what: str, value: str, text: str, **more: str) -> None:
    tag("button", text, type="button", classes="choice", data_choice=what, data_value=value, **more)


def _codes(cell: Row, parameter: Row, words: Words) -> None:
    label = _label(parameter, words)
    name = parameter["name"]
    with tag("div", classes="codes", role="group", aria_label=label, data_parameter=name):
        for code, nodes in cell["paths"].items():
            way = "-".join(str(node) for node in nodes)
            tag("button", code, type="button", classes="choice", data_path=code, data_nodes=way, title=way)


def _rack(cell: Row, words: Words) -> None:
    with tag("div", classes="rack"):
        for station in range(cell["stations"]):
            label = words("tasks.station_label", station=station)
            number = str(station)
            tag("button", number, type="button", classes="place", data_station=number, aria_label=label)


def _grid(cell: Row, words: Words) -> None:
    """Draw a button per node; a click on a start, then on an end, chooses the path between them."""
    rows, columns = cell["grid"]["rows"], cell["grid"]["columns"]
    ends = {nodes[0]: "start" for nodes in cell["paths"].values()}
    ends |= {nodes[-1]: "end" for nodes in cell["paths"].values()}
    letters = {nodes[-1]: code.removeprefix(str(nodes[0])) for code, nodes in cell["paths"].items()}
    with tag("div", classes="grid", style=f"--columns: {columns}", data_columns=str(columns)):
        tag("div", classes="way", aria_hidden="true")
        for node in range(rows * columns):
            kind = ends.get(node, "between")
            label = words(f"tasks.node_{kind}", node=node)
            tag(
                "button",
                f"{node} {letters.get(node, '')}".strip(),
                type="button",
                classes=f"place {kind}",
                data_node=str(node),
                aria_label=label,
                title=label,
            )


def _example(cells: list[Row]) -> str:
    offered = (recipe["example"] for cell in cells for recipe in cell["recipes"])
    return next(offered, "")


def _text(example: str, words: Words) -> None:
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
                placeholder=example,
            )
        act_button(
            words("tasks.send"), "submit", "", words("tasks.send_does"), classes="primary", id="task-send"
        )
    tag("p", id="task-missing", classes="hint", role="status")
    tag("p", words("tasks.send_does"), classes="hint")
