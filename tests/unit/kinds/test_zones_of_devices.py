"""Two devices that get in each other's way take turns: a zone without poses, held while they work."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.plant_model import PlantModel

from ...plants import changed, plant_text, read, refused
from .lab import Bench

PLANT = plant_text(__file__, "zones_of_devices")
RECIPES = """
from arboleda.recipes import parallel, recipe, work

@recipe("hasty")
def hasty(cell):
    ram, feeder = cell.devices("ram", "feeder")
    return parallel(feeder.push(), work(cell.wait(0.5), ram.press(), ram.lift()))

@recipe("blow")
def blow(cell):
    ram, feeder = cell.devices("ram", "feeder")
    return parallel(ram.press(), work(cell.wait(0.5), feeder.blow()))

@recipe("blind")
def blind(cell):
    ram, feeder = cell.devices("ram", "feeder")
    return work(ram.press(), feeder.push())
"""


LOOKS = """
@recipe("look")
def look(cell):
    ram, feeder = cell.devices("ram", "feeder")
    seen = feeder.look()
    ways = {"free": ram.lift(), "jammed": cell.fail("jammed")}
    return work(parallel(seen, work(cell.wait(0.5), ram.press())), cell.choose(seen, ways))
"""


@pytest.fixture
def press(tmp_path: Path) -> Bench:
    here = Bench(read(tmp_path, PLANT, RECIPES))
    here.wait(1.0)
    return here


def test_a_device_waits_while_another_works_in_the_zone(press: Bench) -> None:
    press.submit("press hasty")
    assert press.wait(1.0, lambda: "feeder push" in press.told)
    assert press.plant.zones.holder("mouth") == "feeder"
    press.wait(1.0)
    assert "ram press" not in press.told
    assert press.outcome().state.value == "done"
    assert press.told[:2] == ["feeder push", "ram press"]
    assert press.plant.zones.holder("mouth") is None


def test_a_verb_that_is_not_named_needs_no_zone(press: Bench) -> None:
    press.submit("press blow")
    press.wait(1.0)
    assert press.told == ["ram press", "feeder blow"]
    assert press.outcome().state.value == "done"


def test_a_verb_is_not_told_into_a_zone_that_stays_taken(press: Bench) -> None:
    press.submit("press blind")
    end = press.outcome()
    assert (end.state.value, end.reason.value if end.reason else None) == ("failed", "zone_unavailable")
    assert "feeder push" not in press.told


ASKS = "look: {effect: query, answers: [free, jammed], takes_s: 2}\n      push:"
ASKED = PLANT.replace("push:", ASKS, 1).replace("[push]", "[look]")


def test_a_device_that_is_asked_is_in_the_zone_until_it_has_answered(tmp_path: Path) -> None:
    in_the_zone_until_it_has_answered(read(tmp_path, ASKED, RECIPES + LOOKS), "look")


def in_the_zone_until_it_has_answered(plant: PlantModel, recipe: str) -> None:
    here = Bench(plant)
    here.wait(1.0)
    here.submit(f"press {recipe}")
    assert here.wait(1.0, lambda: "feeder look" in here.told)
    here.wait(1.5)
    assert here.plant.zones.holder("mouth") == "feeder" and "ram press" not in here.told
    assert here.outcome().state.value == "done"
    assert here.told == ["feeder look", "ram press", "ram lift"]


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("[push]", "[pull]", 'zones.mouth.held_while.feeder[0]: must be push or blow, is "pull"'),
        ("{feeder: [push]}", "{feedr: [push]}", 'is "feedr"; did you mean "feeder"?'),
        ("{feeder: [push]}", "{}", "zones.mouth: a zone has poses, moves, or two devices"),
    ],
)
def test_a_wrong_word_is_named_with_what_is_allowed(tmp_path: Path, old: str, new: str, problem: str) -> None:
    found = refused(tmp_path, changed(PLANT, (old, new)), RECIPES)
    assert any(problem in each for each in found), found
