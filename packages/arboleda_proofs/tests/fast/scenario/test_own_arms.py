"""Arms from a URDF of one's own do what the shipped ones do: tasks, approaches, and whatever goes wrong."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.lengths import sample
from tests.unit.plant_file import own_arms

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda.plant_file.robot_models import mobile_models
from arboleda.testing.storage_layout import StorageLayout
from arboleda_drawn.plants import ATTEMPTS, as_yaml
from arboleda_drawn.storage import draw
from arboleda_proofs.campaigns.plants import Plant, PlantRotation
from arboleda_proofs.campaigns.setting import Setting
from arboleda_proofs.testing import Sim

EXAMPLE = own_arms.TENDER.parents[2] / "plants/own_arm.yaml"
SEEDS = range(8)
HALTED_AT_ONCE = (
    146  # a seed whose arm is quicker than its halt may be, and is halted in the step that moves it
)
NAMES = ("gantry.urdf", "one.urdf", "tender.urdf")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """One with three models: six joints that turn, three that slide, and a single one."""
    models = {"gantry": own_arms.GANTRY, "one": own_arms.ONE, "tender": own_arms.TENDER.read_text("utf-8")}
    for name, urdf in models.items():
        (tmp_path / f"{name}.urdf").write_text(urdf, "utf-8")
    return tmp_path


def drawn(folder: Path, seed: int) -> PlantModel:
    """A plant file of that seed, its arms of the models in the folder."""
    made = (own_arms.gantry(folder), own_arms.swing(folder), own_arms.tender(folder))
    arms = {name: own_arms.arm(each).joints for name, each in zip(NAMES, made, strict=True)}
    mobiles = {name: model.speed for name, model in mobile_models().items()}
    for attempt in range(ATTEMPTS):
        file = as_yaml(draw(seed, attempt, arms=arms, mobiles=mobiles)).encode()
        try:
            return loader.parse("drawn.yaml", file, folder)
        except ConfigError as refusal:
            last = refusal
    raise last


@pytest.mark.sampled(3)
@pytest.mark.parametrize("seed", sample([*SEEDS, HALTED_AT_ONCE], every=4))
def test_whatever_goes_wrong_nothing_breaks_with_arms_of_ones_own(folder: Path, seed: int) -> None:
    plant = drawn(folder, seed)
    assert {StorageLayout(cell).arm.model for cell in plant.cells} <= set(NAMES)
    setting = Setting(plants=PlantRotation(plants=(Plant(declared=plant),)), cycles=3, level="normal")
    assert setting.run(seed).broken is None


def test_the_plants_that_are_drawn_have_all_of_them(folder: Path) -> None:
    cells = [cell for seed in SEEDS for cell in drawn(folder, seed).cells]
    assert {StorageLayout(cell).arm.model for cell in cells} == set(NAMES)
    assert any(pose.above for cell in cells for pose in StorageLayout(cell).space.poses)


def test_a_part_is_stored_by_an_arm_of_ones_own(sim: Sim) -> None:
    sim.plant(EXAMPLE)
    task = sim.submit("tending 0B 2")
    sim.run(until=lambda: task.ended)
    assert task.history == ["queued", "running", "done"]
    assert sim.robot("tender").joints == pytest.approx((0,) * 6, abs=0.5)


def test_a_gantry_goes_over_its_station_from_above(tmp_path: Path, sim: Sim) -> None:
    sim.plant(own_arms.gantry(tmp_path))
    task = sim.submit("a 0B 0")
    sim.run(until=lambda: sim.robot("ra").joints == pytest.approx((400, 50, -210), abs=1))
    assert not task.ended
    sim.run(until=lambda: task.ended)
    assert task.state == "done"
