"""Alarms that packages have raised, as the page shows them."""

from __future__ import annotations

from typing import Any

from . import Face
from .moment import Moment

Row = dict[str, Any]
STATES = {"warning": "warning", "error": "failed"}  # how each level looks


def face(moment: Moment) -> Face:
    alarms = alarms_of(moment)
    found: Face = {"rows/alarms": [str(each["id"]) for each in alarms]}
    for each in alarms:
        texts = [each["package"], each["cell"], moment.words.say(each["sentence"])]
        found[f"row/alarms/{each['id']}"] = {"state": STATES[each["level"]], "texts": texts}
    return found


def alarms_of(moment: Moment) -> list[Row]:
    """The alarms of packages; a record of an earlier version has none."""
    return list(moment.snapshot.get("alarms", ()))


def questions_of(moment: Moment) -> list[Row]:
    """The open questions of packages."""
    return list(moment.snapshot.get("questions", ()))


def loud(moment: Moment) -> list[Row]:
    """The alarms for which somebody is needed."""
    return [each for each in alarms_of(moment) if each["level"] == "error"]
