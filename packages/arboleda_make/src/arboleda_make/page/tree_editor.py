"""The editor of trees as XML: its palette, the tree, and the form of a node; the script fills them."""

from __future__ import annotations

from arboleda.dashboard.tags import way
from arboleda.extension import Spot, Words, tag
from arboleda_make.trying.api import MakeApi

HOW = ("into", "before", "around", "instead")  # where a node of the palette goes
ACTS = ("up", "down", "out", "in", "copy", "unwrap", "remove")
OF_TREES = ("add_tree", "extract", "rename_tree", "remove_tree")


def build(spot: Spot) -> None:
    words = spot.words
    with tag("div", id="draw", classes="draw"):
        _bar(spot)
        tag("p", words("draw.empty"), id="draw-empty", classes="box", hidden="true")
        with tag("fieldset", id="draw-desk", classes="draw-desk", aria_label=words("draw.desk")):
            _palette(words)
            _tree(words)
            _form(words)
        tag("p", id="draw-note", role="status", classes="act-note")


def _bar(spot: Spot) -> None:
    words = spot.words
    with tag("div", classes="draw-bar box"):
        with tag("label", words("draw.cell")), tag("select", id="draw-cell"):
            for cell in spot.layout["cells"]:
                tag("option", cell["name"], value=cell["name"])
        with tag("label", words("draw.file")):
            tag("select", id="draw-file")
        with tag("fieldset", classes="draw-acts", aria_label=words("make.steps")):
            for act in ("undo", "redo"):
                _button(words, act)
        _button(words, "download")
        with tag("details", id="draw-python-box", classes="draw-python", hidden="true"):
            tag("summary", words("draw.python"))
            with tag("fieldset", classes="box draw-acts", aria_label=words("draw.python")):
                with tag("label", words("draw.python")):
                    tag("select", id="draw-python")
                with tag("label", words("draw.copy")):
                    tag("input", id="draw-copy", type="text", maxlength="40", autocomplete="off")
                _button(words, "copy_recipe")
        if spot.plant.ask(MakeApi) is not None:
            with tag("div", classes="make-who"):
                tag("p", id="draw-who", role="status")
                tag("button", words("make.act.take"), type="button", classes="act", data_make="take")
            way(words("draw.to_make"), {"tab": "make"}, classes="act primary", data_to_panel="try")


def _palette(words: Words) -> None:
    with tag("div", classes="box draw-palette", role="group", aria_label=words("draw.palette")):
        tag("h2", words("draw.palette"))
        with tag("div", classes="scopes", role="group", aria_label=words("draw.how")):
            for how in HOW:
                tag(
                    "button",
                    words(f"draw.{how}"),
                    type="button",
                    classes="choice",
                    data_how=how,
                    aria_pressed="true" if how == HOW[0] else "false",
                )
        label = words("draw.search")
        tag("input", id="draw-search", type="search", placeholder=label, aria_label=label)
        tag("div", id="draw-kinds")


def _tree(words: Words) -> None:
    with tag("div", classes="box draw-tree"):
        tag("div", id="draw-trees", classes="scopes", role="group", aria_label=words("draw.trees"))
        tag("div", id="draw-rows", role="tree", aria_label=words("draw.tree"), aria_describedby="draw-keys")
        tag("ul", id="draw-general", classes="draw-marks")
        tag("p", words("draw.keys"), id="draw-keys", classes="hint")


def _form(words: Words) -> None:
    with tag("div", classes="box draw-form", role="group", aria_label=words("draw.node")):
        tag("h2", words("draw.node"), id="draw-title")
        tag("p", id="draw-about", classes="hint")
        tag("ul", id="draw-marks", classes="draw-marks")
        with tag("div", classes="draw-acts"):
            for act in ACTS:
                _button(words, act)
        tag("div", id="draw-fields")
        with tag("div", id="draw-twin", hidden="true", role="group", aria_label=words("draw.twin")):
            tag("div", id="draw-twin-view", classes="twin-view")
            tag("button", words("draw.twin_close"), type="button", id="draw-twin-close", classes="act")
        with tag("label", words("draw.name")):
            tag("input", id="draw-name", type="text", maxlength="100", autocomplete="off")
        with tag("div", classes="draw-acts"):
            for act in (*OF_TREES, "add_parameter"):
                _button(words, act)
        tag("div", id="draw-parameters", classes="draw-acts")


def _button(words: Words, act: str, classes: str = "act") -> None:
    tag("button", words(f"draw.act.{act}"), type="button", classes=classes, data_draw=act)
