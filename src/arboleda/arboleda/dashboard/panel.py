"""The operator's panel: choose a scope, see what each verb will do, do it; below it the shared zones."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from arboleda.model.messages import Verb
from arboleda.views.view import devices_once

from .page_api import Layout
from .tags import act_button, live, rows, tag
from .wording import Words


@dataclass(frozen=True, kw_only=True)
class Offer:
    """The scopes that a verb is offered to, and the number of times that a person must confirm it."""

    scopes: str
    asks: int = 0
    by_hand: bool = False


PLANT, CELL, DEVICE = "plant", "cell", "device"
HOLDER, MOVER, MOVER_ALONE = "holder", "mover", "mover_alone"  # for verbs that are not for all
OFFERS: dict[str, tuple[Verb, Offer]] = {
    "stop": (Verb.STOP, Offer(scopes="plant cell device")),
    "clear": (Verb.CLEAR, Offer(scopes="plant cell device")),
    "reset": (Verb.RESET, Offer(scopes="plant cell")),
    "hold": (Verb.HOLD, Offer(scopes="plant cell")),
    "resume": (Verb.RESUME, Offer(scopes="plant cell")),
    "retry": (Verb.RETRY, Offer(scopes="cell")),
    "abandon": (Verb.ABANDON, Offer(scopes="cell")),
    "cancel": (Verb.CANCEL, Offer(scopes="cell")),
    "release": (Verb.RELEASE, Offer(scopes="holder", asks=1)),
    "release_by_hand": (Verb.RELEASE, Offer(scopes="holder", asks=1, by_hand=True)),
    "unload": (Verb.UNLOAD, Offer(scopes="plant cell")),
    "home": (Verb.HOME, Offer(scopes="mover", asks=1)),
    "home_by_hand": (Verb.HOME, Offer(scopes="mover_alone", asks=1, by_hand=True)),
}


def build(layout: Layout, words: Words) -> None:
    with tag("div", classes="box"):
        tag("h2", words("panel.title"))
        _scopes(layout, words)
        for cell in layout["cells"]:
            live("p", f"advice.{cell['name']}", classes="advice", data_advice=cell["name"])
        with tag("ul", classes="verbs"):
            racks = any(cell["stations"] for cell in layout["cells"])
            for name, (verb, offer) in OFFERS.items():
                if racks or verb is not Verb.UNLOAD:
                    _verb(name, verb, offer, words)
        tag("p", words("panel.not_safety"), classes="hint")
        _suggestions(layout)
    zones(words, "acts")


def zones(words: Words, *more: str) -> None:
    """Draw the table of shared zones and devices, with the robot that holds each of them."""
    with tag("div", classes="box"):
        tag("h2", words("zones.title"))
        columns = [words(f"column.{name}") for name in ("zone", "state", "robot", "waiting", *more)]
        rows("zones", columns, empty=words("zones.none"))


def _scopes(layout: Layout, words: Words) -> None:
    with tag("div", classes="scopes", role="group", aria_label=words("panel.scope")):
        _scope("", words("panel.plant"), PLANT)
        for cell in layout["cells"]:
            with _scope(cell["name"], None, *_kinds(CELL, cell["devices"])):
                tag("span", cell["name"])
                live("span", f"scope.{cell['name']}", classes="pill")
    once = [*devices_once(layout["cells"])]
    for cell in layout["cells"]:
        with tag("div", classes="scopes robots", role="group", data_robots=cell["name"]):
            tag("span", words("panel.only"), classes="hint")
            for device in (device for of, device in once if of == cell["name"]):
                alone = [MOVER_ALONE] if device["position"] else []
                _scope(device["name"], device["name"], *_kinds(DEVICE, [device]), *alone)


def _kinds(kind: str, devices: list[dict[str, Any]]) -> list[str]:
    """The kinds of a scope, for verbs that not every device has: `HOLDER` if one of these devices may hold a
    part, `MOVER` if one goes somewhere."""
    holder = [HOLDER] if any(device["holds"] for device in devices) else []
    return [kind, *holder, *([MOVER] if any(device["position"] for device in devices) else [])]


def _scope(scope: str, text: str | None, *kinds: str) -> Any:
    return tag("button", text, type="button", classes="choice", data_scope=scope, data_kind=" ".join(kinds))


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
    """Add hidden elements with the plant's next steps and refusals, from which the script marks buttons."""
    for name in ["plant", *(cell["name"] for cell in layout["cells"])]:
        live("span", f"suggested.{name}", hidden="true", data_suggested=name)
    robots = [device["name"] for _, device in devices_once(layout["cells"])]
    for name in ["plant", *(cell["name"] for cell in layout["cells"]), *robots]:
        live("span", f"refused.{name}", hidden="true", data_refused=name)
