"""Arrays of targets in the plant file: made of their corners, in joints or nodes, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_check import layout_check
from arboleda.plant_file import loader

from ...plants import plant_text

TEXT = plant_text(__file__, "target_arrays")
MISTAKES = {
    "too few corners": (
        "            - {deg: [30, 90], mm: 60, approach_mm: 40}\n",
        "",
        "14:11: cells.bench.groups.pallet.corners.loader: must be a list of 4 corners",
    ),
    "a corner outside the limits": (
        "{deg: [30, 90], mm: 60",
        "{deg: [30, 190], mm: 60",
        "18:26: cells.bench.groups.pallet.corners.loader[3].deg[1]: ",
    ),
    "between nodes": (
        "[{node: 3}, {node: 5}]",
        "[{node: 3}, {node: 4}]",
        "21:19: cells.bench.groups.stops.corners.cart: stops_2 would be between nodes",
    ),
    "no such role": (
        "corners: {cart:",
        "corners: {crt:",
        "21:19: cells.bench.groups.stops.corners.crt: must be loader or cart",
    ),
    "no grid": ("        grid: [1, 3]\n", "", "20:"),
    "a grid of one": ("grid: [1, 3]", "grid: [1, 1]", "20:15: cells.bench.groups.stops.grid: an array has"),
    "half of them lifted": (
        "{deg: [0, 90], mm: 60, approach_mm: 40}",
        "{deg: [0, 90], mm: 60}",
        "14:11: cells.bench.groups.pallet.corners.loader: either every corner has an approach_mm or none",
    ),
    "a target that there is": (
        "      bin: {loader",
        "      pallet_3: {loader",
        '11:7: cells.bench.groups.pallet: it makes a target "pallet_3", and there is one already',
    ),
    "a misspelt target": ("[bin, pallet_12]", "[bin, pallet_13]", "22:19: cells.bench.groups.bins[1]: must"),
}


def load(tmp_path: Path, text: str = TEXT) -> PlantModel:
    (tmp_path / "plant.yaml").write_text(text, "utf-8")
    return loader.load(tmp_path / "plant.yaml", recipes=False)


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


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_named_with_its_line(tmp_path: Path, mistake: tuple[str, str, str]) -> None:
    old, new, told = mistake
    assert old in TEXT
    with pytest.raises(ConfigError) as refusal:
        load(tmp_path, TEXT.replace(old, new, 1))
    found = [each.removeprefix(f"{tmp_path}/plant.yaml:") for each in refusal.value.problems]
    assert [each for each in found if each.startswith(told)], found
