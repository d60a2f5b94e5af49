"""The operator's panel: choose a scope, see what each verb will do, do it; below it the shared zones."""

from __future__ import annotations

import json
from dataclasses import dataclass

from arboleda.core.messages import Verb

from .plant_side import Layout
from .tags import act_button, live, rows, tag
from .wording import Words


@dataclass(frozen=True, kw_only=True)
class Offer:
    """Where a verb is offered, and how often a person is asked before it is done."""

    scopes: str
    asks: int = 0
    by_hand: bool = False


PLANT, CELL, ARM, MOBILE = "plant", "cell", "arm", "mobile"
OFFERS: dict[str, tuple[Verb, Offer]] = {
    "stop": (Verb.STOP, Offer(scopes="plant cell arm mobile")),
    "clear": (Verb.CLEAR, Offer(scopes="plant cell arm mobile")),
    "reset": (Verb.RESET, Offer(scopes="plant cell")),
    "hold": (Verb.HOLD, Offer(scopes="plant cell")),
    "resume": (Verb.RESUME, Offer(scopes="plant cell")),
    "retry": (Verb.RETRY, Offer(scopes="cell")),
    "abandon": (Verb.ABANDON, Offer(scopes="cell")),
    "cancel": (Verb.CANCEL, Offer(scopes="cell")),
    "release": (Verb.RELEASE, Offer(scopes="cell arm", asks=1)),
    "unload": (Verb.UNLOAD, Offer(scopes="plant cell")),
    "home": (Verb.HOME, Offer(scopes="cell arm mobile", asks=1)),
    "home_by_hand": (Verb.HOME, Offer(scopes="arm mobile", asks=1, by_hand=True)),
}


def build(layout: Layout, words: Words) -> None:
    with tag("div", classes="box"):
        tag("h2", words("panel.title"))
        _scopes(layout, words)
        for cell in layout["cells"]:
            live("p", f"advice.{cell['name']}", classes="advice", data_advice=cell["name"])
        with tag("ul", classes="verbs"):
            for name, (verb, offer) in OFFERS.items():
                _verb(name, verb, offer, words)
        tag("p", words("panel.not_safety"), classes="hint")
        _suggestions(layout)
    with tag("div", classes="box"):
        tag("h2", words("zones.title"))
        columns = [words(f"column.{name}") for name in ("zone", "state", "robot", "waiting", "acts")]
        rows("zones", columns, empty=words("zones.none"))


def _scopes(layout: Layout, words: Words) -> None:
    with tag("div", classes="scopes", role="group", aria_label=words("panel.scope")):
        _scope("", words("panel.plant"), PLANT)
        for cell in layout["cells"]:
            with _scope(cell["name"], None, CELL):
                tag("span", cell["name"])
                live("span", f"scope.{cell['name']}", classes="pill")
    for cell in layout["cells"]:
        with tag("div", classes="scopes robots", role="group", data_robots=cell["name"]):
            tag("span", words("panel.only"), classes="hint")
            _scope(cell["arm"], cell["arm"], ARM)
            _scope(cell["mobile"], cell["mobile"], MOBILE)


def _scope(scope: str, text: str | None, kind: str) -> object:
    return tag("button", text, type="button", classes="choice", data_scope=scope, data_kind=kind)


def _verb(name: str, verb: Verb, offer: Offer, words: Words) -> None:
    does = words(f"does.{name}")
    with tag("li", classes="verb", data_verb=name, data_scopes=offer.scopes):
        act_button(
            words(f"verb.{name}"),
            verb.value,
            "$scope",
            does,
            classes=f"verb-{verb.value}",
            data_asks=json.dumps([words(f"asks.{name}")] * offer.asks),
            **({"data_by_hand": "true"} if offer.by_hand else {}),
        )
        tag("p", does, data_does=does)


def _suggestions(layout: Layout) -> None:
    """What the plant would do next, read by the script to mark buttons."""
    for name in ["plant", *(cell["name"] for cell in layout["cells"])]:
        live("span", f"suggested.{name}", hidden="true", data_suggested=name)
    robots = [robot for cell in layout["cells"] for robot in (cell["arm"], cell["mobile"])]
    for name in ["plant", *(cell["name"] for cell in layout["cells"]), *robots]:
        live("span", f"refused.{name}", hidden="true", data_refused=name)
