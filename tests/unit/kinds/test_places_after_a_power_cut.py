"""The books of parts after a power cut, in which nobody knows what an effector holds before it reports."""

from __future__ import annotations

import pytest

from arboleda.model.plant_model import PlantModel
from arboleda.testing import Rig

from ...plants import plant_text, read

PLANT = plant_text(__file__, "places_after_a_power_cut")
RECIPES = """
from arboleda.recipes import recipe, work

@recipe("bring")
def bring(cell):
    loader = cell.device("loader")
    return work(loader.visit("feed", loader.grip()), loader.visit("nest", loader.let_go()), loader.home())
"""


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> PlantModel:
    folder = tmp_path_factory.mktemp("lab")
    return read(folder, PLANT, RECIPES)


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
