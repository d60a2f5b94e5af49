"""The whole page at one moment."""

from __future__ import annotations

from collections import Counter
from typing import Any

from arboleda.views.view import standing, waited_for

from . import Face, cells, links, packages, panel, part_places, questions, ready, stop, tasks, timeline
from .moment import Moment
from .order import WELL, WORST, trouble_first

PARTS = (
    stop.face,
    cells.face,
    ready.face,
    part_places.face,
    questions.face,
    tasks.face,
    panel.face,
    links.face,
    packages.face,
    timeline.face,
)
Row = dict[str, Any]


def face(moment: Moment) -> Face:
    found: Face = {"text/sum": _sum(moment), "text/title": _title(moment), "text/needs": _needs(moment)}
    found |= {"order/cells": [cell["name"] for cell in trouble_first(moment.snapshot)], **_counts(moment)}
    for part in PARTS:
        found.update(part(moment))
    return found


def _sum(moment: Moment) -> list[str]:
    """The line above the page: people who are waited for, slow commits, the end of the plant; coloured by the
    worst state of a cell."""
    states = [standing(cell) for cell in moment.snapshot["cells"]]
    ending = [moment.words("page.ending")] if moment.snapshot["ending"] else []
    people = [name for names in waited_for(moment.snapshot).values() for name in names]
    waits = [_waits(moment, people)] if people else []
    slow = [moment.words("page.memory_slow")] if links.memory(moment)[0] else []
    return [" · ".join([*waits, *slow, *ending]), min(states, key=WORST.index, default="")]


def _counts(moment: Moment) -> Face:
    """The number of cells in each state, each with a link to the first of them."""
    first: dict[str, str] = {}
    for cell in moment.snapshot["cells"]:
        first.setdefault(standing(cell), cell["name"])
    states = Counter(standing(cell) for cell in moment.snapshot["cells"])
    there = [state for state in WORST if state in first]
    found: Face = {"rows/counts": there}
    for state in there:
        found[f"row/counts/{state}"] = {
            "state": state,
            "texts": [f"{moment.words.cell(state)}: {states[state]}"],
            "link": {"column": 0, "to": {"tab": "cells", "cell": first[state], "task": None}},
        }
    return found


def _waits(moment: Moment, people: list[str]) -> str:
    return moment.words("asked.waits", people=", ".join(people))


def _needs(moment: Moment) -> list[str]:
    """The names of the cells that wait for somebody, loud alarms of packages and their questions, for the
    sound."""
    loud = {f"alarm/{each['id']}" for each in packages.loud(moment)}
    asked = {f"question/{each['id']}" for each in packages.questions_of(moment)}
    bad = loud | asked | {cell["name"] for cell in moment.snapshot["cells"] if standing(cell) not in WELL}
    return [" ".join(sorted(bad | waited_for(moment.snapshot).keys())), ""]


def _title(moment: Moment) -> list[str]:
    """The title of the browser's tab: the plant, and before it the cells that wait for somebody and the loud
    alarms of packages."""
    states = {cell["name"]: standing(cell) for cell in moment.snapshot["cells"]}
    bad = {name: moment.words.cell(state) for name, state in states.items() if state not in WELL}
    bad |= {each["package"]: moment.words.say(each["sentence"]) for each in packages.loud(moment)}
    waits = {name: _waits(moment, people) for name, people in waited_for(moment.snapshot).items()}
    waits |= {each["package"]: each["text"] for each in packages.questions_of(moment)}
    causes = "; ".join(f"{name}: {word}" for name, word in (*bad.items(), *waits.items()))
    plant = moment.snapshot["plant"]
    if bad:
        return [f"⚠ {causes} - {plant}", "trouble"]
    return [f"? {causes} - {plant}", "waits"] if waits else [plant, "well"]
