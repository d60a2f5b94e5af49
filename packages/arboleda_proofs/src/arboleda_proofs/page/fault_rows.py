"""Faults that were provoked at virtual devices and go on."""

from __future__ import annotations

from arboleda.dashboard.faces.moment import seconds
from arboleda.extension import Face, Moment

from .fault_acts import END


def face(moment: Moment) -> Face:
    begun = moment.links.get("faults", ())
    found: Face = {"rows/faults": [str(each["number"]) for each in begun]}
    for each in begun:
        about = moment.words.say(each["about"])
        offer = {
            "act": END,
            "of": str(each["number"]),
            "label": moment.words("faults.end"),
            "does": moment.words("faults.end_does", what=about, robot=each["robot"]),
        }
        left = moment.words("faults.left", time=seconds(each["left_s"]))
        found[f"row/faults/{each['number']}"] = {
            "state": "held",
            "texts": [f"{each['robot']}: {about} ({left})"],
            "acts": [offer],
        }
    return found
