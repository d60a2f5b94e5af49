"""The whole page at one moment."""

from __future__ import annotations

from arboleda.views.view import standing, waited_for

from . import Face, asked, cells, links, panel, stop, tasks, timeline
from .moment import Moment

PARTS = (stop.face, cells.face, asked.face, tasks.face, panel.face, links.face, timeline.face)
WORST = (
    "aborted",
    "aborting",
    "clearing",
    "stopped",
    "resetting",
    "held",
    "holding",
    "blocked",
    "paused",
    "execute",
    "idle",
)
WELL = ("execute", "idle")


def face(moment: Moment) -> Face:
    found: Face = {"text/sum": _sum(moment), "text/title": _title(moment), "text/needs": _needs(moment)}
    for part in PARTS:
        found.update(part(moment))
    return found


def _sum(moment: Moment) -> list[str]:
    """How many cells are in which state, the worst of them colours it; and who is waited for."""
    states = [standing(cell) for cell in moment.snapshot["cells"]]
    there = [state for state in WORST if state in states]
    counts = [f"{moment.words.of('cell_state', state)}: {states.count(state)}" for state in there[::-1]]
    ending = [moment.words("page.ending")] if moment.snapshot["ending"] else []
    people = [name for names in waited_for(moment.snapshot).values() for name in names]
    waits = [_waits(moment, people)] if people else []
    return [" · ".join([*counts, *waits, *ending]), there[0] if there else ""]


def _waits(moment: Moment, people: list[str]) -> str:
    return moment.words("asked.waits", people=", ".join(people))


def _needs(moment: Moment) -> list[str]:
    """The names of the cells that wait for somebody, for the sound."""
    bad = {cell["name"] for cell in moment.snapshot["cells"] if standing(cell) not in WELL}
    return [" ".join(sorted(bad | waited_for(moment.snapshot).keys())), ""]


def _title(moment: Moment) -> list[str]:
    """What a browser's tab says: the plant, and before it the cells that wait for somebody."""
    states = {cell["name"]: standing(cell) for cell in moment.snapshot["cells"]}
    bad = {name: moment.words.of("cell_state", state) for name, state in states.items() if state not in WELL}
    waits = {name: _waits(moment, people) for name, people in waited_for(moment.snapshot).items()}
    said = "; ".join(f"{name}: {word}" for name, word in (*bad.items(), *waits.items()))
    plant = moment.snapshot["plant"]
    if bad:
        return [f"⚠ {said} - {plant}", "trouble"]
    return [f"? {said} - {plant}", "waits"] if waits else [plant, "well"]
