"""The arm takes each part where its mobile robot stands, and a recovery brings it back there."""

from __future__ import annotations

import pytest
from tests.scenario.test_part_back import held_with_a_part

from arboleda.model.messages import TaskState, Verb
from arboleda.testing import Rig, shipped
from arboleda_proofs.testing import Witness

TAKEN_AT = {"0A": "pick-up A", "0B": "pick-up", "0C": "pick-up C", "2A": "pick-up A", "1C": "pick-up C"}


@pytest.mark.parametrize("path", TAKEN_AT)
def test_a_part_is_gripped_at_the_pick_up_of_its_exit(path: str) -> None:
    rig = Rig(shipped("sis_a"))
    witness = Witness(rig)
    rig.wait(0.5)
    rig.submit(f"sis_a {path} 7")
    rig.wait_for("sis_a", f"move to {TAKEN_AT[path]}")
    assert rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert [change.state for change in rig.outcomes().values()] == [TaskState.DONE]
    assert (witness.part["ra1"], witness.illegal) == ("station 7", [])


def test_a_recovery_brings_the_part_back_to_the_exit_it_came_from() -> None:
    rig = held_with_a_part(shipped("sis_a"))
    witness = Witness(rig)
    assert rig.operate(Verb.ABANDON, "sis_a") is None
    rig.wait_for("sis_a", "carry back/move to pick-up A")
    assert rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert (witness.part["ra1"], witness.illegal) == ("pick-up A", [])
