"""The arm takes each part where its mobile robot stands, and a recovery brings it back there."""

from __future__ import annotations

from arboleda.model.messages import Verb
from arboleda.model.plant_model import PlantModel
from arboleda.testing import Rig, shipped

from .restarts import crash_without_trail


def held_with_a_part(model: PlantModel) -> Rig:
    """sis_a is held while its arm carries a part from exit A to station 7."""
    rig = Rig(model)
    rig.wait(0.5)
    rig.submit("sis_a 0A 7")
    rig.wait_for("sis_a", "main/move to station 7")
    rig.wait(0.3)
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(1.0)
    return rig


def test_a_plant_that_starts_anew_brings_a_part_to_where_the_mobile_stands() -> None:
    rig = held_with_a_part(shipped("sis_a"))
    crash_without_trail(rig)
    rig.wait(3.0)
    assert rig.operate(Verb.RETRY, "sis_a") is None
    rig.wait_for("sis_a", "carry back/move to pick-up A")
