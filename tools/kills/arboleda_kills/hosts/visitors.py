"""People on another host who bring tasks, each by a way of its own, across whatever befalls the plant."""

from __future__ import annotations

import random
import re
import threading
import time
from collections import Counter
from collections.abc import Mapping, Sequence

from arboleda.model.plant_model import Cell

from ..people import OVER
from .entrances import Way

PACE_S = 2.0  # between two tasks of one of them, and before a task is asked for once more
TRIES = 100


class Visitors:
    """One for each way: it brings the next task as soon as the last was taken, until they `bring` no more.

    `accepted`, `ends` and `contradictions` are as those of customers. `sent`: how many were taken by each
    way. `refused`: how often, by way and sentence.
    """

    def __init__(self, cells: Sequence[Cell], ways: Mapping[str, Way]) -> None:
        self._cells = cells
        self.bring = True
        self.accepted: dict[str, str] = {}
        self.ends: dict[str, str] = {}
        self.contradictions: list[str] = []
        self.sent: Counter[str] = Counter()
        self.refused: Counter[tuple[str, str]] = Counter()
        self._threads = [
            threading.Thread(target=self._visit, args=(*each, f"v{number}"), daemon=True)
            for number, each in enumerate(ways.items())
        ]
        for thread in self._threads:
            thread.start()

    @property
    def are_gone(self) -> bool:
        """True if none of them is waiting for anything."""
        return not any(thread.is_alive() for thread in self._threads)

    def _visit(self, name: str, way: Way, prefix: str) -> None:
        dice, count = random.Random(prefix), 0
        while self.bring:
            count += 1
            cell = dice.choice(self._cells)
            text = f"{cell.name} {dice.choice([*cell.paths])} {count % len(cell.stations)}"
            self._bring(name, way, f"{prefix}-{count}", text)
            time.sleep(PACE_S)

    def _bring(self, name: str, way: Way, id: str, text: str) -> None:
        """Ask with one id, which is one task, until nothing more is in the way."""
        for _ in range(TRIES):
            answer = way(f"{text} #{id}")
            if answer.state:
                self.sent[name] += id not in self.accepted
                self.accepted[id] = text
            if answer.state in OVER and self.ends.setdefault(id, answer.state) != answer.state:
                self.contradictions.append(f"{id} was {self.ends[id]} and then {answer.state}")
            if not answer.sentence:
                return
            self.refused[name, re.sub(r"\d+", "N", answer.sentence)] += 1
            time.sleep(PACE_S)
        self.contradictions.append(f"{id} ({text}) was not taken {name} in {TRIES} tries")
