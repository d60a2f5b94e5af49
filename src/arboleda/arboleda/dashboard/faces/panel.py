"""The operator's panel: how each cell stands, and who has which zone."""

from __future__ import annotations

import json
from collections.abc import Collection
from typing import Any

from arboleda.model.verbs import Verb
from arboleda.views.view import standing

from . import Face
from .cells import trouble
from .moment import Moment
from .order import trouble_first

Row = dict[str, Any]


def face(moment: Moment) -> Face:
    found: Face = {}
    for cell in moment.snapshot["cells"]:
        name = cell["name"]
        found[f"text/scope.{name}"] = moment.words.cell_pill(standing(cell))
        found[f"text/advice.{name}"] = [trouble(moment, cell), standing(cell)]
        found[f"text/suggested.{name}"] = [" ".join(suggested(cell)), ""]
    cells = trouble_first(moment.snapshot)
    every = {verb for cell in cells for verb in suggested(cell) if verb in FOR_ALL}
    found["text/suggested.plant"] = [" ".join(sorted(every)), ""]
    for cell in cells:
        found[f"text/refused.{cell['name']}"] = [_refused(moment, cell["refused"], suggested(cell)), ""]
    for robot in moment.snapshot["robots"]:
        found[f"text/refused.{robot['name']}"] = [_refused(moment, robot["refused"]), ""]
    found["text/refused.plant"] = [_refused(moment, refused_everywhere(cells), every), ""]
    found.update(_zones(moment))
    return found


FOR_ALL = ("clear", "reset", "resume")


def suggested(cell: Row) -> tuple[str, ...]:
    """The verb that a person would want next; none if handwork, or another robot, comes first."""
    first = cell["advice"][0] if cell["advice"] else None
    if first is None or first["hand"] or first["refusal"]:
        return ()
    here = (cell["name"], *(device["name"] for device in cell["devices"] if device["holds"]))
    verb = f"{first['do']}_by_hand" if first["by_hand"] else first["do"]
    return (verb,) if first["scope"] in here else ()


def refused_everywhere(cells: list[Row]) -> dict[str, str]:
    """The verbs that every cell refuses, each with the reason of the first of these cells."""
    first = cells[0]["refused"] if cells else {}
    return {verb: why for verb, why in first.items() if all(verb in cell["refused"] for cell in cells)}


def _refused(moment: Moment, refused: dict[str, str], wanted: Collection[str] = ()) -> str:
    """The reason for which each verb would be refused; a verb that follows one of the `wanted` says that this
    one comes first."""
    words = moment.words
    reasons = {verb: words.say(why) for verb, why in sorted(refused.items())}
    first = next((verb for verb in FOR_ALL if verb in wanted), None)
    if first is not None:
        after = words("ways.after", first=words.of("verb", first))
        reasons |= {verb: after for verb in FOR_ALL[FOR_ALL.index(first) + 1 :] if verb in reasons}
    return json.dumps(reasons)


def _zones(moment: Moment) -> Face:
    words = moment.words
    found: Face = {"rows/zones": [zone["zone"] for zone in moment.snapshot["zones"]]}
    for zone in moment.snapshot["zones"]:
        does = words("zones.override_does", zone=zone["zone"])
        override = {
            "act": Verb.OVERRIDE.value,
            "of": zone["zone"],
            "label": words("verb.override"),
            "does": does,
            "asks": words.asks(Verb.OVERRIDE.value),
        }
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
