"""Tries of a draft: a task with a fault, its record, and the check that would have noticed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from arboleda.model.errors import ArboledaError
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load_with_files
from arboleda.recorder import reader
from arboleda_make.trying.processes import noticing, simulating, tryout
from arboleda_proofs.campaigns import plants

PLANT = """name: lab
uses: [shine.xml]
kinds:
  lamp:
    facts: {lit: bool}
    verbs:
      shine: {effect: switch, sets: {lit: true}, takes_s: 1}
      dark:  {effect: switch, sets: {lit: false}, takes_s: 1}
cells:
  lab: {devices: {lamp: {kind: lamp}, other: {kind: lamp}}}
"""
TREE = """<root BTCPP_format="4" main_tree_to_execute="Shine">
  <BehaviorTree ID="Shine">
    <Sequence>
      <lamp_shine/>
      <other_shine/>
      <other_dark/>
    </Sequence>
  </BehaviorTree>
</root>
"""
Plant = tuple[PlantModel, PlantFiles]


@pytest.fixture
def lab(tmp_path: Path) -> Plant:
    (tmp_path / "plant.yaml").write_text(PLANT)
    (tmp_path / "shine.xml").write_text(TREE)
    return load_with_files(tmp_path / "plant.yaml")


def forgetting(at: float) -> dict[str, Any]:
    return {"kind": "forgets", "at": at, "seconds": 0.0, "target": "lamp", "amount": 0.0, "word": ""}


def late(lab: Plant, folder: Path) -> float:
    """The middle of the last step."""
    found = tryout.tried(*lab, {"task": "lab"}, folder)
    name = "in the middle after other: doing dark"
    return next(float(each["at"]) for each in found["instants"] if each["name"].startswith(name))


def test_a_task_is_tried_and_recorded(lab: Plant, tmp_path: Path) -> None:
    found = tryout.tried(*lab, {"task": "lab"}, tmp_path)
    assert (found["outcome"]["end"], found["cell"], found["faults"]) == ("done", "lab", [])
    assert {each["kind"] for each in found["possible"]} >= {"forgets", "reboot"} and found["instants"]
    assert sum(1 for _ in reader.opened(tmp_path / tryout.RECORD).steps()) > 10


def test_what_nobody_notices_is_said(lab: Plant, tmp_path: Path) -> None:
    (tmp_path / "first").mkdir()
    at = late(lab, tmp_path / "first")
    found = tryout.tried(*lab, {"task": "lab", "faults": [forgetting(at)]}, tmp_path)
    assert found["outcome"]["end"] == "done" and "lamp.lit is false" in found["outcome"]["untrue"][0]


def test_the_check_that_notices_it_is_found_and_is_the_only_change(lab: Plant, tmp_path: Path) -> None:
    faults = [forgetting(late(lab, tmp_path))]
    found = noticing.noticed(lab[0], {"task": "lab", "faults": faults})
    check = {name: found["check"][name] for name in ("role", "fact", "value")}
    assert check == {"role": "lamp", "fact": "lit", "value": "true"} and found["file"] == "shine.xml"
    assert found["outcome"]["end"] == "failed"
    added = '      <lamp_becomes lit="true" at_most_s="2"/>\n'
    assert found["text"] == TREE.replace("      <other_dark/>\n", f"      <other_dark/>\n{added}")


def test_a_fault_that_is_noticed_needs_no_check(lab: Plant) -> None:
    fault = {"kind": "refuses", "at": 2.0, "seconds": 1.0, "target": "lamp", "amount": 0.0, "word": "ocupado"}
    with pytest.raises(ArboledaError, match="noticed by now: the task ends failed"):
        noticing.noticed(lab[0], {"task": "lab", "faults": [fault]})


@pytest.mark.long
def test_a_draft_is_simulated_on_seeds_and_what_breaks_is_said_of_each(lab: Plant) -> None:
    model, files = lab
    plant = plants.Plant(declared=model, files=files)
    rows = [*simulating.simulated(plant, 2, 1)]
    assert [row["seed"] for row in rows] == [1, 2] and not any(map(simulating.is_bad, rows))
    assert simulating.is_bad({**rows[0], "findings": ["task failed: x: y"]})
