"""Robots among the devices of a cell: their targets, single or in arrays, their tools and zones."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.messages import Verb
from arboleda.model.plant_model import Interlock, PlantModel
from arboleda.plant_check import layout_check
from arboleda.plant_file import loader

from ...plants import plant_text, read, written
from ..kinds.lab import Bench

PLANT = plant_text(__file__, "targets")
RECIPES = """\
from arboleda.recipes import Target, recipe, work

@recipe("load")
def load(cell, blank=Target("pallet")):
    loader, jaw, mill, shuttle = cell.devices("loader", "jaw", "mill", "shuttle")
    return work(
        cell.device("ana").ask("Is the mill free?"),
        shuttle.go("feed_2"),
        loader.visit(blank, jaw.close()),
        loader.visit("vise", jaw.open()),
        mill.close(),
        mill.open(),
        shuttle.home(),
    )
"""


def test_robots_have_their_targets_tools_and_zones(tmp_path: Path) -> None:
    (cell,) = read(tmp_path, PLANT, RECIPES).cells
    loader, shuttle = cell.spaces
    assert [pose.name for pose in loader.poses] == ["home", "feed_1", "feed_2", "vise"]
    assert loader.tool is cell.roles["jaw"] and loader.home.name == "home"
    assert [(pose.name, pose.q) for pose in shuttle.poses] == [("home", 0), ("feed_2", 8)]
    assert cell.groups == {"pallet": ("feed_1", "feed_2")}
    assert cell.interlocks == (Interlock(device="mill", zone="inside", free_while=(("door", "open"),)),)
    assert [pose.name for pose in loader.poses if pose.zones] == ["vise"]


def test_what_the_file_describes_works(tmp_path: Path) -> None:
    here = Bench(read(tmp_path, PLANT, RECIPES))
    for blank in ("feed_1", "feed_2"):
        here.submit(f"tending load {blank}")
        here.wait(1.0)
        assert here.operate(Verb.ANSWER, "ana", answer="done") is None
        assert here.outcome().state.value == "done"
    assert here.machines["mill"].facts["door"] == "open"


TEXT = plant_text(__file__, "target_arrays")


def load(tmp_path: Path, text: str = TEXT) -> PlantModel:
    return loader.load(written(tmp_path, text), recipes=False)


def test_targets_lie_row_by_row_between_the_corners(tmp_path: Path) -> None:
    (cell,) = load(tmp_path).cells
    poses = cell.reach["loader"].targets
    assert cell.groups["pallet"] == tuple(f"pallet_{number}" for number in range(1, 13))
    assert cell.groups["bins"] == ("bin", "pallet_12")
    first, second, last = (poses[f"pallet_{number}"] for number in (1, 6, 12))
    one, four, nine, twelve = (poses[f"pallet_{number}"].joints for number in (1, 4, 9, 12))
    assert second.q == pytest.approx(
        [(a * 2 + b) / 6 + (c * 2 + d) / 6 for a, b, c, d in zip(one, four, nine, twelve, strict=True)]
    )
    assert first.above == pytest.approx((*first.joints[:2], 0.04))
    assert last.above == pytest.approx((*last.joints[:2], 0.02))
    assert second.above is not None and second.above[2] == pytest.approx(0.03)


def test_a_single_row_of_a_mobile_robot_has_its_two_ends_on_nodes(tmp_path: Path) -> None:
    (cell,) = load(tmp_path).cells
    assert [cell.reach["cart"].targets[name].q for name in cell.groups["stops"]] == [3, 4, 5]


def test_check_says_how_far_interpolated_joints_are_beside_an_even_grid(tmp_path: Path) -> None:
    (warning,) = layout_check.warnings(load(tmp_path))
    assert warning.startswith("pallet_")
    assert "mm beside an even grid: the joints of loader are interpolated" in warning
    flat = TEXT
    for corner in ("[30, 60]", "[0, 90]", "[30, 90]"):
        flat = flat.replace(f"deg: {corner}", "deg: [0, 60]")  # only the sliding joint differs: exact
    assert layout_check.warnings(load(tmp_path, flat)) == ()
