"""Arms and tools that cells share, in the plant file: what is read, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader

from ...plants import plant_text

TEXT = plant_text(__file__, "shared_robots")
MISTAKES = {
    "another home": (
        "home: {arm: {deg: [0, 0], mm: 0}}",
        "home: {arm: {deg: [5, 0], mm: 0}}",
        "25:14: cells.right.targets.home.arm: robot has another home in left; "
        "what one cell leaves is where the next one begins, so make them equal",
    ),
    "without its tool": (
        "      jaw:  {shared: jaw}\n",
        "",
        "22:7: cells.right.devices.arm: robot carries jaw, so a cell has both; "
        "name jaw in a role, too, {shared: jaw}",
    ),
    "without its robot": (
        "      arm:  {shared: robot}\n",
        "",
        "22:7: cells.right.devices.jaw: jaw goes with robot, so a cell has both; "
        "name robot in a role, too, {shared: robot}",
        "and its targets",
        "of which there are two",
        "and the zone",
    ),
    "a tool of nobody": (
        "tool_of: robot",
        "tool_of: robo",
        '9:35: shared.jaw.tool_of: must be robot, is "robo"; did you mean "robot"?',
    ),
    "a tool that holds nothing": (
        "{kind: gripper, tool_of: robot}",
        "{kind: lamp, tool_of: robot}",
        "9:32: shared.jaw.tool_of: jaw holds no part: none of its verbs has holds: part",
    ),
    "two tools": (
        "tool_of: robot}",
        "tool_of: robot}\n  claw:  {kind: gripper, tool_of: robot}",
        "10:35: shared.claw.tool_of: robot carries jaw already",
        "and no cell has it",
    ),
    "a tool of its own": (
        "      jaw:  {shared: jaw}\n",
        "      jaw:  {shared: jaw}\n      claw: {kind: gripper, tool_of: arm}\n",
        "24:38: cells.right.devices.claw.tool_of: arm is shared, and so is what it carries; "
        'declare it under "shared", with tool_of: robot',
    ),
    "one that does not say where it is": (
        "base: {origin_m: [0, 0]}}",
        "base: {origin_m: [0, 0]}, evidence: state}",
        "8:72: shared.robot.evidence: must be ids or joints: "
        "a shared robot has to say that it is at home before another cell has it",
    ),
    "one that is only drawn": (
        "base: {origin_m: [0, 0]}}",
        "base: {origin_m: [0, 0]}, link: none}",
        "8:68: shared.robot.link: is only drawn; cells share what can be told something",
    ),
    "without targets": (
        "    targets:\n      home: {arm: {deg: [0, 0], mm: 0}}\n      vise: {arm: {deg: [-10, 0], mm: 50}}\n",
        "",
        '20:5: cells.right: arm goes nowhere: the key "targets" is missing',
    ),
}


def load(tmp_path: Path, text: str = TEXT) -> PlantModel:
    (tmp_path / "plant.yaml").write_text(text, "utf-8")
    return loader.load(tmp_path / "plant.yaml", recipes=False)


def test_each_cell_has_targets_of_its_own_for_an_arm_that_it_shares_with_its_tool(tmp_path: Path) -> None:
    model = load(tmp_path)
    left, right = model.cells
    assert model.shared == ("robot", "jaw")
    assert [list(cell.reach["robot"].targets) for cell in model.cells] == [["home", "feed"], ["home", "vise"]]
    assert [cell.reach["robot"].hand.name for cell in model.cells] == ["jaw", "jaw"]
    assert left.reach["robot"].zones == right.reach["robot"].zones == {"table"}
    assert left.together({"robot"}) == right.together({"jaw"}) == {"robot", "jaw"}


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_named_with_its_line(tmp_path: Path, mistake: tuple[str, ...]) -> None:
    old, new, sentence = mistake[:3]
    assert old in TEXT
    with pytest.raises(ConfigError) as refusal:
        load(tmp_path, TEXT.replace(old, new, 1))
    found = [each.removeprefix(f"{tmp_path}/plant.yaml:") for each in refusal.value.problems]
    assert sentence in found, found
    assert len(found) == 1 + len(mistake[3:]), found


def test_paths_and_handovers_of_a_shared_robot_are_refused(tmp_path: Path) -> None:
    text = TEXT.replace(
        "    targets:\n      home: {arm",
        "    handover: {taker: arm, giver: lamp, at: vise}\n    targets:\n      home: {arm",
    )
    with pytest.raises(ConfigError) as refusal:
        load(tmp_path, text)
    rule = "cells.right.handover.taker: robot is shared; a handover is between two robots of one cell"
    assert any(rule in each for each in refusal.value.problems), refusal.value.problems
