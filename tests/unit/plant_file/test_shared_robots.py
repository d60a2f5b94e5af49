"""Arms and tools that cells share, in the plant file: what is read, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader

from ...plants import plant_text, written

TEXT = plant_text(__file__, "shared_robots")


def load(tmp_path: Path, text: str = TEXT) -> PlantModel:
    return loader.load(written(tmp_path, text), recipes=False)


def test_each_cell_has_targets_of_its_own_for_an_arm_that_it_shares_with_its_tool(tmp_path: Path) -> None:
    model = load(tmp_path)
    left, right = model.cells
    assert model.shared == ("robot", "jaw")
    assert [list(cell.reach["robot"].targets) for cell in model.cells] == [["home", "feed"], ["home", "vise"]]
    assert [cell.reach["robot"].hand.name for cell in model.cells] == ["jaw", "jaw"]
    assert left.reach["robot"].zones == right.reach["robot"].zones == {"table"}
    assert left.together({"robot"}) == right.together({"jaw"}) == {"robot", "jaw"}


def test_paths_and_handovers_of_a_shared_robot_are_refused(tmp_path: Path) -> None:
    text = TEXT.replace(
        "    targets:\n      home: {arm",
        "    handover: {taker: arm, giver: lamp, at: vise}\n    targets:\n      home: {arm",
    )
    with pytest.raises(ConfigError) as refusal:
        load(tmp_path, text)
    rule = "cells.right.handover.taker: robot is shared; a handover is between two robots of one cell"
    assert any(rule in each for each in refusal.value.problems), refusal.value.problems
