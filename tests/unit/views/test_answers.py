"""A view is what the types of answers say of it, whatever goes on in the plant."""

from __future__ import annotations

import json
from dataclasses import fields
from pathlib import Path
from typing import Any

import arboleda
from arboleda.client.answers.plant import Cell, Robot, Snapshot
from arboleda.client.answers.tasks import Task
from arboleda.client.reading import read
from arboleda.model.messages import Verb
from arboleda.model.sentence import in_json
from arboleda.plant_file.loader import load
from arboleda.testing import Rig, shipped
from arboleda.web.schema.answers import model_of

ADDED_BY_THE_SERVER = {"key", "values"}  # of the sentence on a task
KITTING = Path(arboleda.__file__).parent / "examples/kitting/plant.yaml"


def answered(rig: Rig) -> Snapshot:
    """The view as a client has it, once its description was held against it."""
    text = json.dumps(rig.snapshot(), default=in_json)
    model_of(Snapshot).model_validate_json(text, strict=True)
    rows = json.loads(text)
    for name, kind in (("cells", Cell), ("robots", Robot), ("tasks", Task)):
        told = {key for row in rows[name] for key in row}
        assert told >= {each.name for each in fields(kind)} - ADDED_BY_THE_SERVER
    snapshot: Snapshot = read(Snapshot, rows)
    return snapshot


def asked(rig: Rig) -> Any:
    return next(robot["question"] for robot in rig.snapshot()["robots"] if robot["name"] == "packer")


def test_parts_at_places_and_a_question_to_a_person() -> None:
    rig = Rig(load(KITTING))
    rig.wait(0.5)
    rig.submit("kitting kit 1 tray_1")
    assert rig.wait(120.0, lambda: rig.plant.cells["kitting"].task is None)
    rig.submit("packing collect")
    assert rig.wait(120.0, lambda: asked(rig) is not None)
    snapshot = answered(rig)
    kitting, packing = snapshot.cells
    assert kitting.places and packing.task is not None and packing.task.answers
    assert [robot.name for robot in snapshot.robots if robot.question is not None] == ["packer"]


def test_a_cell_that_is_stopped_and_one_that_is_taught() -> None:
    rig = Rig(shipped())
    rig.wait(0.5)
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    assert rig.operate(Verb.STOP, "sis_a") is None
    assert rig.operate(Verb.TEACH, "sis_b", teacher="ana") is None
    rig.wait(5.0)
    snapshot = answered(rig)
    stopped, taught = snapshot.cells[:2]
    assert stopped.advice and stopped.refused and taught.teaching is not None
    assert [act.verb for act in snapshot.acts] == ["stop", "teach"]
