"""The contents of the page on many plants as flat plain data: trouble first. Pure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

from arboleda.dashboard.faces.order import WELL, WORST
from arboleda.extension import Face, Words
from arboleda.views.view import standing

from ..page.oee_rows import UNKNOWN
from .side import LastSeenPlant

SILENT = "offline"
ORDER = (SILENT, *WORST)
Row = dict[str, Any]


def face(plants: Sequence[LastSeenPlant], words: Words) -> Face:
    """A row for each plant, the one that needs somebody most at the top, and the sums over all of them."""
    in_order = sorted(plants, key=lambda plant: (ORDER.index(state_of(plant)), plant.name))
    found: Face = {"rows/plants": [plant.name for plant in in_order]}
    for plant in in_order:
        found[f"row/plants/{plant.name}"] = _row(plant, words)
    return found | {"text/sum": _sum(plants, words), "text/title": _title(plants, words)}


def state_of(plant: LastSeenPlant) -> str:
    """The state of a plant: the worst of its cells, SILENT if it does not answer."""
    if plant.silent is not None or plant.snapshot is None:
        return SILENT
    states = [standing(cell) for cell in plant.snapshot["cells"]]
    return min(states, key=WORST.index, default=WORST[-1])


def whole_oee(rows: Iterable[Row]) -> float | None:
    """The OEE of several cells, each weighted by its planned time; None if it is unknown."""
    known = [
        (row["oee"], row["planned_s"]) for row in rows if row["oee"] is not None and row["planned_s"] > 0
    ]
    planned_s = sum(seconds for _, seconds in known)
    return sum(share * seconds for share, seconds in known) / planned_s if planned_s else None


def _row(plant: LastSeenPlant, words: Words) -> Row:
    state = state_of(plant)
    tasks = _tasks(plant)
    texts = [
        _state_text(state, words),
        plant.name,
        _why(plant, words),
        words("site.open_tasks", running=tasks["running"], waiting=tasks["queued"])
        if _is_there(plant)
        else "",
        words("oee.counted", **_ended([plant])) if plant.oee and _is_there(plant) else "",
        _percent(whole_oee(plant.oee if _is_there(plant) else ())),
    ]
    return {
        "state": state,
        "texts": texts,
        "link": {"column": 1, "href": plant.url} if plant.url.startswith(("http://", "https://")) else None,
        "acts": [_stop(plant, words)],
    }


def _stop(plant: LastSeenPlant, words: Words) -> Row:
    return {
        "act": "stop",
        "of": plant.name,
        "label": words("site.stop_one"),
        "does": words("site.stop_one_does", plant=plant.name),
    }


def _state_text(state: str, words: Words) -> str:
    return words("site.silent") if state == SILENT else words.cell(state)


def _is_there(plant: LastSeenPlant) -> bool:
    return state_of(plant) != SILENT


def _why(plant: LastSeenPlant, words: Words) -> str:
    """The reason for which a plant is silent or its cells do not work, and the number of its standbys."""
    parts = [words.say(plant.silent)] if plant.silent is not None else []
    for cell in plant.snapshot["cells"] if plant.snapshot and plant.silent is None else ():
        stands = standing(cell)
        if stands not in WELL:
            why = cell["held_by"] or cell["not_ready"]
            parts.append(f"{cell['name']}: {why or words.cell(stands)}")
    if plant.standbys and plant.silent is None:
        parts.append(words("site.stands_by", count=plant.standbys))
    return "; ".join(parts)


def _tasks(plant: LastSeenPlant) -> Counter[str]:
    tasks = plant.snapshot["tasks"] if plant.snapshot and _is_there(plant) else ()
    return Counter(task["state"] for task in tasks)


def _ended(plants: Iterable[LastSeenPlant]) -> dict[str, int]:
    rows = [row for plant in plants for row in plant.oee]
    return {key: sum(row[key] for row in rows) for key in ("done", "failed")}


def _sum(plants: Sequence[LastSeenPlant], words: Words) -> list[str]:
    """The number of plants in each state, coloured by the worst; tasks and OEE of all."""
    states = Counter(map(state_of, plants))
    there = [state for state in ORDER if state in states]
    counts = [f"{_state_text(state, words)}: {states[state]}" for state in there[::-1]]
    tasks = sum((_tasks(plant) for plant in plants), Counter[str]())
    present = [plant for plant in plants if _is_there(plant)]
    figures = [words("site.plants", count=len(plants)), *counts]
    if present:
        figures += [
            words("site.open_tasks", running=tasks["running"], waiting=tasks["queued"]),
            words("oee.counted", **_ended(present)),
            f"OEE {_percent(whole_oee(row for plant in present for row in plant.oee))}",
        ]
    return [" · ".join(figures), there[0] if there else ""]


def _title(plants: Sequence[LastSeenPlant], words: Words) -> list[str]:
    """The title of the browser's tab: the plants that need somebody."""
    bad = sorted(plant.name for plant in plants if state_of(plant) not in WELL)
    if not bad:
        return [words("site.title"), "well"]
    return [f"⚠ {', '.join(bad[:3])}{' ...' if len(bad) > 3 else ''} - {words('site.title')}", "trouble"]


def _percent(share: float | None) -> str:
    return UNKNOWN if share is None else f"{100 * share:.0f} %"
