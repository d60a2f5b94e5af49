"""What `check` says of needs that no device can ever meet."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.plant_check import checks

from ...plants import read

PLANT = """
name: lab
uses: [turn.xml]
kinds:
  oven:
    facts: {{door: [closed, open]}}
    verbs:
      open: {{effect: motion, sets: {{door: open}}}}
      bake: {{effect: process, takes_s: 2{own}}}
  mill:
    facts: {{guard: [shut, up]}}
    verbs:
      turn: {{effect: process, takes_s: 2, sets: {{guard: shut}}}}
cells:
  lab:
    devices:
      oven: {{kind: oven, evidence: {evidence}}}
      mill: {{kind: mill}}
    needs: {{mill.turn: {{oven.door: open}}}}
"""
TREE = '<root BTCPP_format="4"><BehaviorTree ID="Turn"><mill_turn/></BehaviorTree></root>'
OWN = ", needs: {door: open}"
SILENT = "of oven, and oven reports no facts (evidence: state); it is always refused; write another evidence"


@pytest.mark.parametrize(
    ("own", "evidence", "said"),
    [
        ("", "ids", []),
        (OWN, "facts", []),
        ("", "state", [f"lab: mill turn needs door {SILENT}"]),
        (OWN, "state", [f"lab: oven bake needs door {SILENT}", f"lab: mill turn needs door {SILENT}"]),
    ],
)
def test_it_names_verbs_that_need_what_a_device_never_reports(
    tmp_path: Path, own: str, evidence: str, said: list[str]
) -> None:
    plant = read(tmp_path, PLANT.format(own=own, evidence=evidence), beside={"turn.xml": TREE})
    assert list(checks.unmet_needs(plant)) == said
