"""Words of a person on parts, at each moment of each step that moves one: the judge counts on no more than
what somebody can know.
"""

from __future__ import annotations

import re

import pytest
from tests.plants import read
from tests.unit.kinds.test_places import PLANT, recipe_of

from arboleda.model.plant_model import Evidence, PlantModel
from arboleda.testing import shipped
from arboleda_proofs.simulator.faults.kind import Fault
from arboleda_proofs.simulator.run import Result, Simulation
from arboleda_proofs.simulator.scripted_people import script_from

TICK_S, HOP_S = 0.001, 0.2
GRIP = re.compile(r" *(\d+\.\d+) +plant +Remember fact=effector name=\w+ value=(switching|on|off)")
Grips = list[tuple[float, float]]  # from the command to a hand to its end
MOMENTS = {
    "just before it is told": lambda begin, end: begin - TICK_S,
    "as it is told": lambda begin, end: begin,
    "meanwhile": lambda begin, end: (begin + end) / 2,
    "just before its end": lambda begin, end: end - TICK_S,
    "at its end": lambda begin, end: end,
    "just after its end": lambda begin, end: end + TICK_S,
}
WORDS = [
    "unload",
    "unload {cell}",
    "unload {cell} {place}",
    "load {cell} {place}",
    "release {hand}",
    "release {hand} --by-hand",
]


@pytest.fixture(scope="module")
def plants(tmp_path_factory: pytest.TempPathFactory) -> dict[str, PlantModel]:
    """Hands that tell their end at once, by a timer, and as devices of their own that take their time."""
    body = 'take("rack_1"), put("nest"), mover.home()'
    return {
        "told": shipped("sis_a", evidence=Evidence.IDS),
        "timed": shipped("sis_a", evidence=Evidence.JOINTS),
        "tool": read(tmp_path_factory.mktemp("lab"), PLANT, recipe_of(body)),
    }


RACK = {"task": "sis_a 0B 7", "cell": "sis_a", "place": "station_7", "other": "station_3", "hand": "ra1"}
LAB = {"task": "lab try", "cell": "lab", "place": "nest", "other": "bin", "hand": "hand"}
NAMES = {"told": RACK, "timed": RACK, "tool": LAB}


def run(model: PlantModel, names: dict[str, str], *faults: Fault, word: str = "", at: float = 0.0) -> Result:
    before = {"at": 1.0, "do": "load {cell} {other}".format(**names)}  # so that there is something to unload
    said = [{"at": at, "do": word.format(**names)}] if word else []
    people = [before, {"at": 2.0, "task": names["task"]}, *said]
    script = script_from(model, {"people": people, "seconds": 40})
    plan = {0: faults}
    simulation = Simulation(model, 1, lambda minute: plan.get(minute, ()), keep=True, script=script)
    return simulation.run()


def grips_of(result: Result) -> Grips:
    assert result.broken is None and result.outcomes == {"done": 1}
    times = [float(found[1]) for found in map(GRIP.match, result.lines) if found]
    return list(zip(times[::2], times[1::2], strict=True))


_known: dict[tuple[str, int], tuple[list[Fault], float, float]] = {}


def grip(plants: dict[str, PlantModel], plant: str, number: int) -> tuple[list[Fault], float, float]:
    """One of the grips of a task, to take and to let go, and a hop that makes it last."""
    if (plant, number) not in _known:
        model, names = plants[plant], NAMES[plant]
        begin, end = grips_of(run(model, names))[number]
        hop = [Fault(at=begin - 2 * TICK_S, kind="bridge_stall", seconds=HOP_S)] if begin == end else []
        _known[plant, number] = (hop, *grips_of(run(model, names, *hop))[number])
    return _known[plant, number]


@pytest.mark.sampled(60)
@pytest.mark.parametrize("late", [False, True], ids=["in time", "in one step with what follows"])
@pytest.mark.parametrize("word", WORDS)
@pytest.mark.parametrize("moment", MOMENTS)
@pytest.mark.parametrize("number", [0, 1], ids=["takes", "lets go"])
@pytest.mark.parametrize("plant", NAMES)
def test_a_right_plant_is_not_called_broken(
    plants: dict[str, PlantModel], plant: str, number: int, moment: str, word: str, late: bool
) -> None:
    hop, begin, end = grip(plants, plant, number)
    at = round(MOMENTS[moment](begin, end), 6)
    stall = [Fault(at=at - 2 * TICK_S, kind="plant_stall", seconds=5 * TICK_S)] if late else []
    result = run(plants[plant], NAMES[plant], *hop, *stall, word=word, at=at)
    assert result.broken is None
    asked = [line.split()[2] for line in result.lines if line.split()[1] == "asked"]
    assert word.partition(" ")[0] in asked[2:]
