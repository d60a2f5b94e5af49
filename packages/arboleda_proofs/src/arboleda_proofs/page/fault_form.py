"""Form of faults by hand: with whom, for how long, and a button for each kind."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from arboleda.extension import Layout, PageApi, Sentence, Spot, Words, rows, tag
from arboleda_proofs.running.api import FaultsApi

LASTING_S = (2, 5, 15, 60)


@dataclass(frozen=True, kw_only=True)
class Target:
    """Whom something can befall: how scripts and people call it, and the kinds with their words. `cells` are
    those in whose menus it is offered; it is in none where that is empty."""

    name: str
    label: str
    kinds: Mapping[str, Sentence]
    cells: tuple[str, ...] = ()


def targets(plant: PageApi, layout: Layout) -> list[Target]:
    """The virtual devices of a plant that runs, with what can be provoked there; none: no drawer."""
    desk, kinds = plant.ask(FaultsApi), dict[str, dict[str, Sentence]]()
    for offer in () if desk is None else desk.offers():
        kinds.setdefault(offer.robot, {})[offer.kind] = offer.about
    return [
        Target(name=name, label=name, kinds=each, cells=_cells_of(name, layout))
        for name, each in kinds.items()
    ]


def _cells_of(robot: str, layout: Layout) -> tuple[str, ...]:
    """The cells that have this device: several where they share it."""
    cells = layout["cells"]
    return tuple(each["name"] for each in cells if robot in {one["name"] for one in each["devices"]})


def drawer(spot: Spot) -> None:
    """Draw the drawer in the menu of each cell of a plant that runs."""
    words, found = spot.words, targets(spot.plant, spot.layout)
    if not found:
        return
    with tag("details", id="faults", classes="fault-drawer"):
        tag("summary", words("faults.title"))
        form(words, found)
        tag("p", words("faults.about"), classes="hint")


def going_on(spot: Spot) -> None:
    """Draw the list of faults that go on, each with a button that ends it."""
    if targets(spot.plant, spot.layout):
        rows("faults", [""], classes="fault-rows")


def form(words: Words, targets: Sequence[Target]) -> None:
    """Draw the form; `assets/faults.js` has only those buttons shown that are possible."""
    with tag("div", classes="fault-choices"):
        with tag("label", classes="field"):
            tag("span", words("faults.whom"))
            with tag("select", id="fault-target"):
                for each in targets:
                    kinds, cells = " ".join(each.kinds), " ".join(each.cells)
                    tag("option", each.label, value=each.name, data_kinds=kinds, data_cells=cells)
        with tag("label", classes="field"):
            tag("span", words("faults.how_long"))
            with tag("select", id="fault-seconds"):
                for seconds in LASTING_S:
                    chosen = {"selected": "true"} if seconds == LASTING_S[1] else {}
                    tag("option", f"{seconds} s", value=str(seconds), **chosen)
    with tag("div", classes="fault-buttons"):
        abouts = {kind: about for each in targets for kind, about in each.kinds.items()}
        for kind, about in abouts.items():
            tag("button", words.say(about), type="button", classes="act", data_fault=kind)
