"""Logbook of a simulated plant: rows of what happened in it, and the last tree of each cell."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from arboleda.dashboard.findings import findings
from arboleda.engine import Plant
from arboleda.extension import words
from arboleda.views import view
from arboleda.views.chronicle import Chronicle
from arboleda.views.resting_cells import RestingCells
from arboleda_proofs.simulator.faults.titles import title
from arboleda_proofs.simulator.judged_world import JudgedWorld

from .drawn import Happening

FAULT = "fault"  # the first word of a line of the timeline, in some case
BEGINS, OVER = "begins", "over"
LASTING = re.compile(r" (for [\d.]+ s)$")


class Logbook:
    """Logbook: what the page's time line would have, the steps of each cell, and the faults; `rows`, `trees`.

    A tree is kept when its task has ended, as it was just before: its rows.
    """

    def __init__(self, language: str) -> None:
        self.rows: list[Happening] = []
        self.trees: dict[str, list[dict[str, Any]]] = {}
        self._say = words(language).say
        self._language = language
        self._steps: dict[str, str] = {}
        self._watched: JudgedWorld | None = None
        self._plant: Plant | None = None

    def follow(self, watched: JudgedWorld) -> None:
        """Follow a world from now on; what is so already is no news."""
        self._watched = watched
        self._start(watched.world.plant)
        watched.world.watchers.insert(0, self._look)  # before anything judges the step

    def hear(self, line: str) -> None:
        """Take in a line of the timeline: of these, those of faults."""
        _, word, text = line.split(maxsplit=2)
        if word.lower() == FAULT and self._watched is not None:
            what = OVER if text.startswith(OVER) else BEGINS
            fault = self._named(text.removeprefix(OVER).strip())
            self.rows.append(Happening(self._watched.seconds, "", FAULT, "", what, fault))

    def _named(self, line: str) -> str:
        """A fault of a line by its name: whom it befalls, how, and for how long."""
        kind, target, word = (*line.split(" "), "", "")[:3]
        lasting = LASTING.search(line)
        return findings(self._language)(
            f"{target}: {title(kind, word)}{f', {lasting[1]}' if lasting else ''}"
        )

    def _start(self, plant: Plant) -> None:
        """Begin with a plant that has just begun; one that died and began anew knows nothing of before."""
        self._plant, self._resting, self._last_number = plant, RestingCells(), 0
        self._chronicle = Chronicle()
        if not self.rows:
            self._chronicle.see(self._snapshot(plant), 0.0)
            self._last_number = len(self._chronicle.events)

    def _look(self) -> None:
        assert self._watched is not None
        plant, now = self._watched.world.plant, self._watched.seconds
        if plant is not self._plant:
            self._start(plant)
        snapshot = self._snapshot(plant)
        self.trees |= {cell["name"]: cell["tree"] for cell in snapshot["cells"] if cell["tree"]}
        self._chronicle.see(snapshot, now)
        self.rows += sorted(
            (*self._events(), *self._new_steps(snapshot["cells"], now)), key=lambda row: row.at
        )

    def _snapshot(self, plant: Plant) -> dict[str, Any]:
        return view.snapshot(plant, self._resting.part)

    def _events(self) -> Iterator[Happening]:
        for event in self._chronicle.events:
            if event["number"] > self._last_number:
                self._last_number = event["number"]
                yield Happening(
                    at=event["at"],
                    cell=event["cell"] or "",
                    kind=event["kind"],
                    subject=event["subject"],
                    what=event["what"],
                    sentence=self._say(event["sentence"]),
                )

    def _new_steps(self, cells: list[dict[str, Any]], now: float) -> Iterator[Happening]:
        for cell in cells:
            name, step = cell["name"], self._say(cell["step"] or "")
            if step and step != self._steps.get(name):
                yield Happening(
                    at=now, cell=name, kind="step", subject=name, what=str(cell["step"]), sentence=step
                )
            self._steps[name] = step
