"""Differences of devices as a file that `simulate` and `prove` take, without names.

A device is its number in the plant file, a fact its number in the device's kind, a driver is named if it
comes with Arboleda. A word that a device said is left as it is if the code of such a driver has it, as
GRBL's `hard_limit`; any other becomes `word_1`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from arboleda.drivers import Robot
from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.recurring import MOST_A_MINUTE

from .reading import Unlike

OURS = "arboleda_drivers"
WORDS = re.compile(r'"([a-z][a-z0-9_]*)"')
SAID = ("gave_up", "refused")  # rules whose word the device said
TOP = """\
# What devices told that virtual ones cannot tell, for --faults of arboleda simulate and arboleda prove.
# There are no names in here: a device has its number in the plant file, a fact its number in its kind.
"""


def as_yaml(found: Iterable[Unlike], model: PlantModel, minutes: float) -> str:
    """The content of the file."""
    names = _Names(model)
    rows = [f"  - {_flow(names.row(each, minutes))}" for each in found]
    return "\n".join([f"{TOP}unlike:{'' if rows else ' []'}", *rows, ""])


class _Names:
    """Numbers and words that stand for the names of a plant."""

    def __init__(self, model: PlantModel) -> None:
        self._model = model
        self._robots = [*model.robots]
        self._words: dict[str, str] = {}

    def row(self, each: Unlike, minutes: float) -> dict[str, object]:
        worst, robot = each.worst, self._model.robots[each.worst.robot]
        row: dict[str, object] = {"what": worst.rule, "device": self._robots.index(robot.name) + 1}
        row |= {"driver": _driver(robot)} if robot.driver is not None else {}
        row |= {"word": self._word(worst.word)} if worst.rule in SAID else {}
        row |= {"seconds": round(worst.seconds, 3)} if worst.seconds else {}
        row |= {"amount": round(worst.amount, 3)} if worst.amount else {}
        row |= {"times": each.times, "per_minute": _per_minute(each.times, minutes)}
        return row | ({} if each.fault is None else {"fault": self._fault(each, robot)})

    def _fault(self, each: Unlike, robot: Robot) -> dict[str, object]:
        fault = each.fault
        assert fault is not None
        facts = [*robot.fact_names] if robot.verb_names else []
        row: dict[str, object] = {"kind": fault.kind}
        row |= {"seconds": round(fault.seconds, 3)} if fault.seconds else {}
        row |= {"amount": round(fault.amount, 3)} if fault.amount else {}
        if fault.word in facts:
            return row | {"fact": facts.index(fault.word) + 1}
        said = each.worst.rule == "gave_up" and bool(fault.word)
        return row | ({"word": self._word(fault.word) if said else fault.word} if fault.word else {})

    def _word(self, word: str) -> str:
        if word in _words_of_drivers():
            return word
        return self._words.setdefault(word, f"word_{len(self._words) + 1}")


def _per_minute(times: int, minutes: float) -> float:
    return min(round(times / max(minutes, 1.0), 3), MOST_A_MINUTE)


def _driver(robot: Robot) -> str:
    """The name of its driver, if it comes with Arboleda."""
    assert robot.driver is not None
    return robot.driver.name if _is_ours(robot) else "own"


def _is_ours(robot: Robot) -> bool:
    return type(getattr(robot.driver, "settings", None)).__module__.partition(".")[0] == OURS


@cache
def _words_of_drivers() -> frozenset[str]:
    """All words that stand in the code of the drivers that come with Arboleda; none if they are not here."""
    found = find_spec(OURS)
    folders = [] if found is None else [Path(each) for each in found.submodule_search_locations or ()]
    texts = (file.read_text("utf-8") for folder in folders for file in folder.rglob("*.py"))
    return frozenset(word for text in texts for word in WORDS.findall(text))


def _flow(row: Mapping[str, object]) -> str:
    return f"{{{', '.join(_pairs(row))}}}"


def _pairs(row: Mapping[str, object]) -> Iterator[str]:
    for key, value in row.items():
        shown = _flow(value) if isinstance(value, Mapping) else json.dumps(value)
        yield f"{key}: {shown}"
