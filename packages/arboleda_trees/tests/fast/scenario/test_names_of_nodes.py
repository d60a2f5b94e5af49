"""Nodes whose names begin alike, or are those of another kind's, are still those of their own devices."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.scenario.restarts import ENDED

from arboleda.model.errors import ConfigError
from arboleda.model.messages import TaskState
from arboleda.plant_file.loader import load
from arboleda.testing import Rig
from arboleda_trees.bt_xml import leaves

KINDS = """
name: mills
uses: [t.xml]
kinds:
  mill:
    facts: {up: bool}
    verbs:
      door_open: {effect: switch, sets: {up: true}, takes_s: 0.5}
      ask: {effect: query, answers: [fine], takes_s: 0.2}
      visit: {effect: motion, takes_s: 0.5}
  door:
    facts: {closed: bool}
    verbs:
      close: {effect: switch, sets: {closed: true}, takes_s: 0.5}
  bell:
    verbs:
      tells: {effect: motion, takes_s: 0.5}
"""
CELL = "cells: {c: {devices: {mill: {kind: mill}, %s: {kind: door}, bell: {kind: bell}}}}"


def rig(folder: Path, body: str, role: str = "mill_door") -> Rig:
    (folder / "plant.yaml").write_text(KINDS + CELL % role)
    tree = f'<BehaviorTree ID="T"><Sequence>{body}</Sequence></BehaviorTree>'
    (folder / "t.xml").write_text(f'<root BTCPP_format="4">{tree}</root>')
    made = Rig(load(folder / "plant.yaml"))
    made.wait(5.0)
    return made


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("<mill_door_open/><mill_door_close/>", ["mill door_open", "mill_door close"]),
        ('<mill_ask answer="{a}"/>', ["mill ask"]),
        ("<mill_visit/>", ["mill visit"]),
        ("<bell_tells/>", ["bell tells"]),
    ],
)
def test_each_node_is_that_of_its_device(tmp_path: Path, body: str, told: list[str]) -> None:
    here = rig(tmp_path, body)
    here.submit("c t #one")
    assert here.wait(20.0, until=lambda: here.outcomes()["one"].state in ENDED)
    assert here.outcomes()["one"].state is TaskState.DONE
    assert [f"{each.robot} {each.verb}" for each in here.sent if hasattr(each, "definition")] == told


def test_two_roles_that_would_make_one_node_are_named(tmp_path: Path) -> None:
    opens = KINDS.replace("      close:", "      open: {effect: motion, takes_s: 0.5}\n      close:")
    (tmp_path / "plant.yaml").write_text(opens + CELL % "mill_door")
    (tmp_path / "t.xml").write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="T"><mill_ask/></BehaviorTree></root>'
    )
    with pytest.raises(ConfigError, match="mill and mill_door both make a node mill_door_open"):
        leaves.of_cells(load(tmp_path / "plant.yaml", recipes=False).cells)
