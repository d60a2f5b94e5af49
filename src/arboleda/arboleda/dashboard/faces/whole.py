"""The whole page at one moment."""

from __future__ import annotations

from . import Face, cells, links, panel, stop, tasks, timeline
from .moment import Moment

PARTS = (stop.face, cells.face, tasks.face, panel.face, links.face, timeline.face)
WORST = ("aborted", "aborting", "clearing", "stopped", "resetting", "held", "holding", "execute", "idle")


def face(moment: Moment) -> Face:
    found: Face = {"text/sum": _sum(moment)}
    for part in PARTS:
        found.update(part(moment))
    return found


def _sum(moment: Moment) -> list[str]:
    """How many cells are in which state; the worst of them colours it."""
    states = [cell["state"] for cell in moment.snapshot["cells"]]
    there = [state for state in WORST if state in states]
    counts = [f"{moment.words.of('cell_state', state)}: {states.count(state)}" for state in there[::-1]]
    ending = [moment.words("page.ending")] if moment.snapshot["ending"] else []
    return [" · ".join([*counts, *ending]), there[0] if there else ""]
