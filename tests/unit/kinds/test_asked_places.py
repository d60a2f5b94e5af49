"""Places between two cells that share an arm, and the books of parts after a power cut."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.core.plant import Plant
from arboleda.model.plant_model import PlantModel
from arboleda.recipes.place_questions import PlaceHandle, PlaceQuestion
from arboleda.testing import Rig

from ...plants import plant_text, read, refused

PLANT = plant_text(__file__, "asked_places")
RECIPES = """
from arboleda.recipes import recipe, work

def carry(cell, source, goal):
    arm, jaw = cell.devices("arm", "jaw")
    taken = arm.visit(source, jaw.close(width_mm=30, force_n=20))
    return [taken, arm.visit(goal, jaw.open()), arm.home()]

@recipe("give")
def give(cell):
    room = cell.place("pass").has_room()
    return work(room, cell.choose(room, {True: carry(cell, "in_1", "pass"), False: []}))

@recipe("take")
def take(cell):
    return work(cell.place("pass").gets_part(at_most_s=8), *carry(cell, "pass", "out_1"))
"""


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ('cell.place("in_1")', "right has no place 'in_1'; there are pass, out_1"),
        ("cell.choose(cell.place('pass').has_part(), {True: []})", "choose has no way for False"),
        (
            "cell.choose(cell.place('pass').has_part(), {'yes': []})",
            "look for a part at pass never answers 'yes'",
        ),
    ],
)
def test_what_a_place_is_not_or_never_answers_is_refused(tmp_path: Path, wrong: str, sentence: str) -> None:
    code = RECIPES.replace("return work(cell.place", f"{wrong}\n    return work(cell.place")
    assert any(sentence in each for each in refused(tmp_path, PLANT, code))


def test_the_answer_of_a_place_outlives_a_start_of_the_plant(tmp_path: Path) -> None:
    context = Plant(read(tmp_path, PLANT, RECIPES), epoch=0, now=0.0).cells["left"].context
    asked, restored = (PlaceHandle("pass", context).has_room() for _ in range(2))
    assert isinstance(asked, PlaceQuestion) and isinstance(restored, PlaceQuestion)
    assert asked.kept() is None
    asked.tick_once()
    kept = asked.kept()
    assert kept is not None
    restored.restore(kept)
    assert restored.answer is True


NEST = plant_text(__file__, "places_after_a_power_cut")
BRINGS = """
from arboleda.recipes import recipe, work

@recipe("bring")
def bring(cell):
    loader = cell.device("loader")
    return work(loader.visit("feed", loader.grip()), loader.visit("nest", loader.let_go()), loader.home())
"""


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> PlantModel:
    folder = tmp_path_factory.mktemp("lab")
    return read(folder, NEST, BRINGS)


def parts_after_a_cut(model: PlantModel, at_s: float) -> int | None:
    """The parts in the books of the next start, if the power is cut so late in a task; None after its end."""
    rig = Rig(model)
    rig.wait(1.0)
    rig.submit("lab bring")
    rig.wait(at_s)
    if rig.plant.cells["lab"].task is None:
        return None
    rig.plant_process.cut_power(0)
    rig.plant_process.start()
    rig.settle()
    rig.wait(1.0)
    places = rig.plant.cells["lab"].context.places
    return sum(places.counts.values()) + sum(places.carriers.values())


@pytest.mark.long
def test_no_part_is_booked_twice_whenever_the_power_is_cut(model: PlantModel) -> None:
    found = [parts_after_a_cut(model, tenths / 10) for tenths in range(1, 70)]
    lasted = found.index(None)
    assert lasted > 20
    assert set(found[:lasted]) == {1}
