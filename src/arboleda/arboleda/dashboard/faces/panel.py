"""The operator's panel: how each cell stands, and who has which zone."""

from __future__ import annotations

from typing import Any

from . import Face
from .cells import trouble
from .moment import Moment

Row = dict[str, Any]
SUGGESTED: dict[str, tuple[str, ...]] = {
    "aborted": ("clear",),
    "clearing": ("clear",),
    "stopped": ("reset",),
}


def face(moment: Moment) -> Face:
    found: Face = {}
    for cell in moment.snapshot["cells"]:
        name = cell["name"]
        found[f"text/scope.{name}"] = [moment.words.of("cell_state", cell["state"]), cell["state"]]
        found[f"text/advice.{name}"] = [trouble(moment, cell, None), cell["state"]]
        found[f"text/suggested.{name}"] = [" ".join(suggested(cell)), ""]
    every = {verb for cell in moment.snapshot["cells"] for verb in suggested(cell) if verb in FOR_ALL}
    found["text/suggested.plant"] = [" ".join(sorted(every)), ""]
    found.update(_zones(moment))
    return found


FOR_ALL = ("clear", "reset", "resume")


def suggested(cell: Row) -> tuple[str, ...]:
    """The verbs that a person would want next."""
    if cell["state"] == "held":
        said = cell["held_by"] or ""
        return tuple(verb for verb in ("release", "resume", "retry", "abandon") if f"{verb} " in said)
    if cell["state"] == "idle" and cell["paused"]:
        return ("resume",)
    return SUGGESTED.get(cell["state"], ())


def _zones(moment: Moment) -> Face:
    words = moment.words
    found: Face = {"rows/zones": [zone["zone"] for zone in moment.snapshot["zones"]]}
    for zone in moment.snapshot["zones"]:
        does = words("zones.override_does", zone=zone["zone"])
        override = {"act": "override", "of": zone["zone"], "label": words("verb.override"), "does": does}
        found[f"row/zones/{zone['zone']}"] = {
            "state": zone["state"],
            "texts": [
                zone["zone"],
                words.of("zone_state", zone["state"]),
                zone["robot"] or "",
                ", ".join(zone["waiting"]),
            ],
            "acts": [override] if zone["state"] == "quarantined" else [],
        }
    return found
