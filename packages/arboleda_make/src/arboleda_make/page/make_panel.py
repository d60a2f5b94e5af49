"""Make: the draft of the plant's files, its cells and recipes, tries, proofs, new devices."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from arboleda.dashboard.tags import way
from arboleda.extension import Spot, Words, tag
from arboleda.plant_file.robot_models import arm_models
from arboleda_make.trying.api import MakeApi

PANELS = ("draft", "cells", "try", "prove", "device", "proposals")
FREE = "proposals"  # whoever edits the draft; all else is for who edits
STEPS = ("undo", "redo", "check", "discard")
BUDGETS_S = (30, 120, 600)
STANDS = ("x_m", "y_m", "yaw_deg")  # where a robot stands


def build(spot: Spot) -> None:
    words = spot.words
    with tag("div", id="make", classes="make"):
        if spot.plant.ask(MakeApi) is None:
            with tag("div", classes="box"):
                tag("h2", words("make.shipped"))
                tag("p", words("make.shipped_how"))
            return
        _bar(words)
        with tag("div", classes="scopes", role="group", aria_label=words("make.panels")):
            for name in PANELS:
                pressed = "true" if name == PANELS[0] else "false"
                label = words(f"make.panel.{name}")
                tag(
                    "button",
                    label,
                    type="button",
                    classes="choice",
                    data_make_panel=name,
                    aria_pressed=pressed,
                )
        for name, build_panel in _BUILD.items():
            label = words(f"make.panel.{name}")
            hidden = {} if name == PANELS[0] else {"hidden": "true"}
            element = "div" if name == FREE else "fieldset"
            with tag(
                element, id=f"make-{name}", classes="make-panel", role="group", aria_label=label, **hidden
            ):
                build_panel(words)
        tag("p", id="make-note", role="status", classes="act-note")


def _bar(words: Words) -> None:
    with tag("div", classes="make-bar box"):
        with tag("div", classes="make-who"):
            tag("p", id="make-who", role="status")
            with tag("label", words("make.name")):
                tag("input", id="make-name", type="text", maxlength="60", autocomplete="nickname")
            _button(words, "take")
        with tag("fieldset", classes="draw-acts", aria_label=words("make.steps")):
            for step in STEPS:
                _button(words, step)
            _button(words, "keep", classes="act primary")
        with tag("fieldset", id="make-not-ours", hidden="true"):
            tag("p", words("make.not_ours"))
            _button(words, "own", classes="act primary")


def _draft(words: Words) -> None:
    with tag("div", classes="box"):
        tag("h2", words("make.changes"))
        tag("ul", id="make-changes", classes="make-lines")
        tag("h2", words("make.problems"))
        tag("ul", id="make-problems", classes="draw-marks")
        tag("ul", id="make-offers", classes="draw-marks")
        for name in ("set_aside", "restart", "waiting"):
            with tag("div", id=f"make-{name}-box", hidden="true"):
                tag("h2", words(f"make.{name}"))
                tag("ul", id=f"make-{name}", classes="make-lines")
        with tag("label", words("make.note")):
            tag("input", id="make-version-note", type="text", maxlength="200", autocomplete="off")
        with tag("div", classes="draw-acts"):
            way(words("make.versions"), {"tab": "settings"}, classes="act")


def _cells(words: Words) -> None:
    with tag("div", classes="box"):
        tag("h2", words("make.new_recipe"))
        with tag("div", id="make-carry", classes="make-form"):
            _field(words, "recipe", maxlength="40")
            for name in ("cell", "robot", "start", "end"):
                _select(words, name)
            _button(words, "carry", classes="act primary")
            _button(words, "empty")
        tag("p", words("make.carry_how"), classes="hint")
    with tag("div", id="make-cell-list"):
        tag("p", words("make.reading"), classes="hint")


def _try(words: Words) -> None:
    with _box(words, "try"):
        with tag("div", classes="make-form"):
            _select(words, "try_recipe")
            _field(words, "task", maxlength="200")
            _button(words, "try", classes="act primary")
        with tag("div", id="make-fault-form", classes="make-form", hidden="true"):
            _select(words, "fault")
            _select(words, "instant")
            _button(words, "try_fault")
        tag("p", id="make-try-state", role="status")
        tag("p", id="make-fault-about", classes="hint")
        with tag("div", id="make-tried", classes="draw-acts", hidden="true"):
            for part in ("twin", "cells", "events"):
                way(
                    words(f"make.look.{part}"),
                    {"tab": part, "at": "0", "record": "draft"},
                    classes="act",
                )


def _prove(words: Words) -> None:
    with _box(words, "prove"):
        with tag("div", classes="make-form"):
            _select(words, "prove_recipe")
            _select(words, "prove_kind")
            with tag("label", words("make.field.budget")), tag("select", id="make-budget"):
                for seconds in BUDGETS_S:
                    tag("option", words("make.seconds", seconds=seconds), value=str(seconds))
            _button(words, "prove", classes="act primary")
            _button(words, "prove_end")
        tag("p", id="make-prove-state", role="status")
        tag("progress", id="make-progress", hidden="true", max="1", aria_label=words("make.progress"))
        tag("div", id="make-proof")


def _device(words: Words) -> None:
    with _box(words, "device"):
        with tag("div", classes="make-form"):
            _select(words, "device_cell")
            _field(words, "new_cell", maxlength="32", about=True)
            _field(words, "role", maxlength="32", about=True)
            _select(words, "kind", about=True)
        with tag("div", classes="make-form"):
            with tag("label", words("make.field.model")), tag("select", id="make-model"):
                for name in arm_models():
                    tag("option", name, value=name)
            for name in STANDS:
                _field(words, name, inputmode="decimal")
            _select(words, "tool_of", about=True)
            _field(words, "answers", about=True)
        with tag("div", id="make-kind-form"):
            _field(words, "new_kind", maxlength="32", about=True)
            tag("h3", words("make.facts"))
            tag("p", words("make.facts_about"), classes="hint")
            tag("div", id="make-facts", classes="make-rows")
            tag("h3", words("make.verbs"))
            tag("p", words("make.verbs_about"), classes="hint")
            tag("div", id="make-verbs", classes="make-rows")
            with tag("div", classes="draw-acts"):
                _button(words, "add_fact")
                _button(words, "add_verb")
        with tag("div", id="make-driver-form"):
            with tag("div", classes="make-form"):
                _select(words, "driver", about=True)
            tag("div", id="make-settings", classes="make-form")
        with tag("div", classes="make-form"):
            _button(words, "add_device", classes="act primary")
            _button(words, "reach")
            _button(words, "new_device", hidden="true")
        tag("p", words("make.reach_how"), id="make-reach-state", role="status", classes="hint")


def _proposals(words: Words) -> None:
    with _box(words, "proposals"):
        tag("ul", id="make-proposal-list", classes="make-lines")
        tag("p", id="make-proposals-note", role="status", classes="act-note")
        tag("div", id="make-proposal")


_BUILD = {
    "draft": _draft,
    "cells": _cells,
    "try": _try,
    "prove": _prove,
    "device": _device,
    "proposals": _proposals,
}


@contextmanager
def _box(words: Words, panel: str) -> Iterator[None]:
    """A box with the panel's name and what it is for."""
    with tag("div", classes="box"):
        tag("h2", words(f"make.panel.{panel}"))
        tag("p", words(f"make.{panel}_how"), classes="hint")
        yield


def _field(words: Words, name: str, *, about: bool = False, **attributes: str) -> None:
    _labelled("input", words, name, about=about, type="text", autocomplete="off", **attributes)


def _select(words: Words, name: str, *, about: bool = False) -> None:
    _labelled("select", words, name, about=about)


def _labelled(element: str, words: Words, name: str, *, about: bool, **attributes: str) -> None:
    with tag("label", words(f"make.field.{name}")):
        if about:
            attributes["aria_describedby"] = f"make-{name}-about"
        tag(element, id=f"make-{name}", **attributes)
        if about:
            tag("small", words(f"make.about.{name}"), id=f"make-{name}-about")


def _button(words: Words, act: str, classes: str = "act", **attributes: str) -> None:
    tag("button", words(f"make.act.{act}"), type="button", classes=classes, data_make=act, **attributes)
