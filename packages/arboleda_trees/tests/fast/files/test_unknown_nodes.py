"""Nodes of a tree that nobody makes are told all at once."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.plant_file.test_wrong_call import PLANT

from arboleda.model.errors import ConfigError
from arboleda.plant_file.loader import load

TREE = """<root BTCPP_format="4"><BehaviorTree ID="Go"><Sequence>
<press_opne/>
<pres_open/>
<press_opne/>
</Sequence></BehaviorTree></root>
"""


def test_all_nodes_of_a_tree_that_no_device_makes_are_told_at_once_each_kind_once(tmp_path: Path) -> None:
    (tmp_path / "go.xml").write_text(TREE)
    (tmp_path / "plant.yaml").write_text(PLANT.replace("recipes.py", "go.xml"))
    with pytest.raises(ConfigError) as refused:
        load(tmp_path / "plant.yaml")
    said = [each.removeprefix(f"{tmp_path}/go.xml:").partition(";")[0] for each in refused.value.problems]
    assert said == [
        "2:1: go: no device of a makes a node press_opne",
        "3:1: go: no device of a makes a node pres_open",
    ]
