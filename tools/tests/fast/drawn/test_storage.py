"""Plant files drawn from a seed: in form as people write them, every key in use."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from itertools import combinations
from typing import Any

import pytest

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Evidence, Link, PlantModel
from arboleda.plant_file import shapes
from arboleda.plant_file.robot_models import arm_models, mobile_models
from arboleda.testing.storage_layout import StorageLayout
from arboleda_drawn.plants import loaded, of_storage
from arboleda_drawn.storage import NOT_DRAWN, draw, smaller
from arboleda_proofs.campaigns.plants import Plant

SEEDS = range(120)
LINKS = set(Link) - {Link.SCREEN, Link.DRIVER}  # a person is a device, and drivers are not drawn
ARMS = {name: model.joints for name, model in arm_models().items()}
MOBILES = {name: model.speed for name, model in mobile_models().items()}


def drawn(seed: int, attempt: int = 0) -> dict[str, Any]:
    return draw(seed, attempt, arms=ARMS, mobiles=MOBILES)


@pytest.fixture(scope="module")
def taken() -> list[Plant]:
    return [of_storage(seed) for seed in SEEDS]


@pytest.fixture
def files(taken: list[Plant]) -> list[dict[str, Any]]:
    return [plant.file for plant in taken if plant.file is not None]


@pytest.fixture
def plants(taken: list[Plant]) -> list[PlantModel]:
    return [plant.declared for plant in taken]


def test_a_seed_draws_the_same_and_another_something_else() -> None:
    assert drawn(7) == drawn(7) != drawn(8)
    assert drawn(7, 1) != drawn(7)


@pytest.mark.long
def test_a_drawn_file_is_refused_only_for_what_its_parts_mean_together() -> None:
    found = [_problems(drawn(seed)) for seed in SEEDS]
    times = ("effector_settle_s", "piece_debounce_s", "stop_timeout_s")
    expected = (
        ": zones.",
        "comes by its last node",
        "longer than computed",
        *(f"timing.{key}" for key in times),
    )
    assert all(any(words in each for words in expected) for problems in found for each in problems), found
    assert found.count(()) > len(SEEDS) / 2


def _problems(file: dict[str, Any]) -> tuple[str, ...]:
    try:
        loaded(file)
    except ConfigError as refusal:
        return refusal.problems
    return ()


@pytest.mark.long
def test_every_key_of_a_plant_file_is_drawn_but_those_that_say_so(files: list[dict[str, Any]]) -> None:
    found = {place for file in files for place in _keys(file)}
    wanted = {
        "": shapes.PlantShape,
        "timing": shapes.TimingShape,
        "cells": shapes.CellShape,
        "retry": shapes.RetryShape,
        "arm": shapes.ArmShape,
        "mobile": shapes.MobileShape,
        "base": shapes.BaseShape,
        "grid": shapes.GridShape,
        "home": shapes.PositionShape,
        "pickup": shapes.PoseShape,
        "stations": shapes.RackShape,
        "palletizing": shapes.PalletizingShape,
        "zones": shapes.ZoneShape,
    }
    missing = {(name, key) for name, shape in wanted.items() for key in shape.model_fields} - found
    assert missing == set(NOT_DRAWN)


def _keys(value: Any, place: tuple[str, ...] = ()) -> Iterator[tuple[str, str]]:
    """Every key with the section in which it stands; cells and zones each count as one."""
    if not isinstance(value, dict):
        return
    section = next((name for name in reversed(place) if not _is_named(name)), "")
    for key, inner in value.items():
        yield section, key
        yield from _keys(inner, (*place, key))


def _is_named(key: str) -> bool:
    return key.startswith(("cell_", "zone_")) or key.isdigit() or len(key) == 1


@pytest.mark.long
def test_every_level_link_and_model_is_drawn_in_mixtures(plants: list[PlantModel]) -> None:
    arms = {
        (StorageLayout(cell).arm.evidence, StorageLayout(cell).arm.link, StorageLayout(cell).arm.model)
        for plant in plants
        for cell in plant.cells
    }
    assert arms == {(level, link, model) for level in Evidence for link in LINKS for model in ARMS}
    mixed = {
        (StorageLayout(cell).arm.evidence, StorageLayout(cell).mobile.evidence)
        for plant in plants
        for cell in plant.cells
    }
    assert mixed == {(one, other) for one in Evidence for other in Evidence}


@pytest.mark.long
def test_odd_plants_are_drawn(plants: list[PlantModel]) -> None:
    cells = [cell for plant in plants for cell in plant.cells]
    assert {len(plant.cells) for plant in plants} == {1, 2, 3, 4}
    assert any(
        StorageLayout(cell).arm.motion.reached(a.q, b.q)
        for cell in cells
        for a, b in combinations(StorageLayout(cell).space.poses, 2)
    )
    assert any(len(path.nodes) == 1 for cell in cells for path in StorageLayout(cell).paths)
    assert any(
        path.nodes[0] == path.nodes[-1] and path.nodes[1:]
        for cell in cells
        for path in StorageLayout(cell).paths
    )
    assert any(cell.queue_limit == 1 for cell in cells)
    assert any(cell.retry.times and cell.retry.backoff_s == 0 for cell in cells)
    assert any(cell.piece_check and StorageLayout(cell).arm.piece_on_change for cell in cells)
    assert not all(robot.has_stop for plant in plants for robot in plant.robots.values())
    assert any(plant.timing.dwell_s == 0 for plant in plants)
    assert any(plant.timing.stop_timeout_s < 0.1 and plant.timing.deadline_floor_s < 0.3 for plant in plants)
    assert any(cell.zone_wait_s < 0.1 for cell in cells)
    assert any(robot.timeout_s < 0.1 for cell in cells for robot in cell.robots)
    assert any(len(_sharing(plant, zone)) > 1 for plant in plants for zone in plant.zones)
    assert any(
        pose.zones
        for cell in cells
        if StorageLayout(cell).space.crossings
        for pose in StorageLayout(cell).space.poses
    )


def _sharing(plant: PlantModel, zone: str) -> list[str]:
    return [cell.name for cell in plant.cells if zone in StorageLayout(cell).space.zones]


@pytest.mark.long
def test_each_smaller_file_lacks_something(files: list[dict[str, Any]]) -> None:
    file = next(file for file in files if len(file.get("zones", {})) > 1)
    before = deepcopy(file)
    less = list(smaller(file))
    assert file == before and all(len(str(each)) < len(str(file)) for each in less)
    assert any("zones" not in each for each in less)


@pytest.mark.long
def test_without_a_cell_no_zone_names_it(files: list[dict[str, Any]]) -> None:
    file = next(file for file in files if len(file["cells"]) > 2 and "zones" in file)
    fewer = [each for each in smaller(file) if len(each["cells"]) < len(file["cells"])]
    assert len(fewer) == len(file["cells"])
    for each in fewer:
        names = [problem for problem in _problems(each) if "there is no cell" in problem]
        assert not names
