"""The operator's panel: choose a scope, see what each verb will do, do it; below it the shared zones."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from arboleda.model.verbs import STATION, Devices, Scope, Verb
from arboleda.views.view import devices_once

from .page_api import Layout
from .tags import act_button, live, rows, tag
from .wording import Words

PLANT, CELL, DEVICE = "plant", "cell", "device"
HOLDER, MOVER, MOVER_ALONE = "holder", "mover", "mover_alone"  # for verbs that are not for all
KINDS = {Scope.PLANT: PLANT, Scope.CELL: CELL, Scope.ROBOT: DEVICE}


@dataclass(frozen=True, kw_only=True)
class Offer:
    """A verb as it is offered, by hand or not, and the kinds of scopes to which it is."""

    verb: Verb
    scopes: tuple[str, ...]
    by_hand: bool = False


def offers(verb: Verb) -> Iterator[tuple[str, Offer]]:
    """The ways in which a verb is offered, by the names of their words; none for what is elsewhere."""
    kinds = tuple(KINDS[scope] for scope in verb.row.scopes if scope in KINDS)
    if verb.row.devices is not Devices.ALL:
        kinds = (HOLDER if verb.row.devices is Devices.HOLDERS else MOVER,)
    if verb.needs_arguments:
        return
    if kinds:
        yield verb.value, Offer(verb=verb, scopes=kinds)
    if kinds and verb.row.by_hand:
        alone = tuple(MOVER_ALONE if kind == MOVER else kind for kind in kinds)
        yield f"{verb.value}_by_hand", Offer(verb=verb, scopes=alone, by_hand=True)


OFFERS = dict(offer for verb in Verb for offer in offers(verb))


def build(layout: Layout, words: Words) -> None:
    with tag("div", classes="box"):
        tag("h2", words("panel.title"))
        _scopes(layout, words)
        for cell in layout["cells"]:
            live("p", f"advice.{cell['name']}", classes="advice", data_advice=cell["name"])
        with tag("ul", classes="verbs"):
            stores = any(cell["stations"] or cell["places"] for cell in layout["cells"])
            for name, offer in OFFERS.items():
                if stores or STATION not in offer.verb.arguments:
                    _verb(name, offer, words)
        tag("p", words("panel.not_safety"), classes="hint")
        _suggestions(layout)


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


def _verb(name: str, offer: Offer, words: Words) -> None:
    does = words(f"does.{name}")
    with tag("li", classes="verb", data_verb=name, data_scopes=" ".join(offer.scopes)):
        act_button(
            words(f"verb.{name}"),
            offer.verb.value,
            "$scope",
            does,
            classes=f"verb-{offer.verb.value}",
            data_asks=json.dumps(words.asks(name)),
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
