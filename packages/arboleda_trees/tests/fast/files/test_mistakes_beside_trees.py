"""A mistake in one file of a plant brings no others in trees that use what the file has."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.plants import problems_of
from tests.unit.plant_file.test_own_recipes import BROKEN, GOOD, PLANT, SECOND, problems, write

TREE = """<root BTCPP_format="4"><BehaviorTree ID="Turn"><own_step to="{to}"/></BehaviorTree><TreeNodesModel>
<SubTree ID="Turn"><input_port name="to"/></SubTree></TreeNodesModel></root>"""
THREE_FILES = PLANT.replace("[recipes.py]", "[recipes.py, more.py, turn.xml]")


@pytest.mark.parametrize("recipes", [GOOD, GOOD.replace('"heat"', '"turn_it"') + BROKEN])
def test_a_node_of_a_file_that_is_wrong_brings_no_others(tmp_path: Path, recipes: str) -> None:
    (tmp_path / "more.py").write_text(BROKEN, "utf-8")
    (tmp_path / "turn.xml").write_text(TREE, "utf-8")
    found = problems(tmp_path, recipes, THREE_FILES + "    recipes: [heat, turn]\n")
    assert found and all("cannot be imported" in each for each in found)


def test_a_cell_without_the_device_that_lists_the_values_of_a_tree_is_told_of_its_node(
    tmp_path: Path,
) -> None:
    body = '<BehaviorTree ID="Warm"><oven_heat celsius="{celsius}"/></BehaviorTree>'
    ports = '<SubTree ID="Warm"><input_port name="celsius"/></SubTree>'
    tree = f'<root BTCPP_format="4">{body}<TreeNodesModel>{ports}</TreeNodesModel></root>'
    (tmp_path / "warm.xml").write_text(tree, "utf-8")
    file = write(tmp_path, GOOD, (PLANT + SECOND).replace("recipes.py", "warm.xml"))
    (found,) = problems_of(file)
    assert found.endswith("(no device of shelf makes a node oven_heat; there are lamp_look)")
