"""The strip at the lower edge: what was provoked last, what it did or why nothing, and what is advised."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from arboleda.engine import RECOVERY
from arboleda.extension import Face, Words
from arboleda.model.plant_model import PlantModel
from arboleda.views.chronicle import is_failure
from arboleda.views.tree_view import RUNS
from arboleda.web.languages import texts
from arboleda_proofs.simulator.mishaps import MISHAPS

from .acts import MishapBegun
from .effects import Provoked
from .film import FilmRun
from .run import TICK_S, Run

HAND, LIST = "hand", "happened"
PROCESSES = ("plant", "bridge", "broker")
Row = dict[str, Any]
Say = Callable[[str], str]  # the playground's own texts, by key


class Strip:
    """Strip: tells of a run of this plant in one language; its first moment is `began_unix_s`."""

    def __init__(self, words: Words, model: PlantModel, *, began_unix_s: float) -> None:
        self._words = words
        self._own: Say = texts(words.language, "playground").__getitem__
        self._model = model
        self._began_unix_s = began_unix_s

    def face(self, run: Run | FilmRun, shown: Mapping[str, Any]) -> Face:
        """The rows of the strip; `shown` is the face of the page."""
        rows: Row = {}
        for last in run.provoked[-1:]:
            rows["last"] = {"state": "provoked", "texts": [self.name(last.act), self._did(last, run)]}
        for cell in run.snapshot["cells"]:
            rows |= dict(_advised(self._words, cell, shown))
        return {f"rows/{LIST}": [*rows], **{f"row/{LIST}/{of}": row for of, row in rows.items()}}

    def name(self, act: MishapBegun) -> str:
        """A mishap in words: when, at whom, what."""
        whole = int(act.tick * TICK_S)
        robots = (robot.name for robot in self._model.robots.values() if robot.mqtt == act.target)
        whom = named(self._own, next(robots, act.target))
        return f"{whole // 60}:{whole % 60:02} {whom}: {self._words.say(MISHAPS[act.name].sentence)}"

    def _did(self, provoked: Provoked, run: Run | FilmRun) -> str:
        """The result of a mishap until now, or the reason why it has none."""
        cells = {cell.name for cell in self._model.cells_of.get(provoked.name, self._model.cells)}
        since = self._began_unix_s + provoked.at_s
        events = [each for each in run.state.chronicle.events if each["at"] > since]
        for event in events:
            if is_failure(event) and event["cell"] in cells:
                return self._words.say(event["sentence"])
        if provoked.effect.nothing:
            return self._own(provoked.effect.word)
        for cell in run.snapshot["cells"]:
            if cell["name"] in cells and _recovers(cell):
                return self._own("recovering").format(cell=cell["name"])
        for event in events:
            if event["subject"] == provoked.name and event["what"] == "offline":
                return self._words("events.robot", subject=provoked.name, what=self._words("links.offline"))
        if provoked.seconds and run.seconds >= provoked.at_s + provoked.seconds:
            return self._own("mishap_over")
        return self._own(provoked.effect.word or "nothing_yet")


def _recovers(cell: Row) -> bool:
    """True while the work of a task has failed and its recovery runs: the task fails once that is over."""
    return any(node["phase"] == RECOVERY and node["status"] == RUNS for node in cell["tree"])


def named(own: Say, target: str) -> str:
    """A robot has its name; a process of the plant is said in words."""
    return own(f"target_{target}") if target in PROCESSES else target


def _advised(words: Words, cell: Row, shown: Mapping[str, Any]) -> Iterator[tuple[str, Row]]:
    """The next thing that leads a cell out of its trouble, and what is to be done at machines themselves,
    each with its button."""
    possible = [each for each in enumerate(cell["advice"]) if not each[1]["refusal"]]
    for number, advice in possible:
        of, why = f"{advice['do']} {advice['scope']}", words.say(advice["why"])
        if advice["hand"]:
            label = words.say(advice["said"])
            act = {"act": HAND, "of": of, "label": label[:1].upper() + label[1:], "does": why}
            yield of, {"state": "advised", "texts": [cell["name"], why], "acts": [act]}
        elif number == possible[0][0]:
            acts = shown[f"row/ways.{cell['name']}/{number}"]["acts"]
            yield of, {"state": "advised", "texts": [cell["name"], why], "acts": acts}
