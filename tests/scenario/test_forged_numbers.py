"""Commands in the plant's name that it never gave: seen at once, halted, and the next task is done."""

from __future__ import annotations

import pytest

from arboleda.kinds.arm import MoveJoints
from arboleda.simulator.world import BRIDGE
from arboleda.testing import shipped
from arboleda.testing.rig import Rig
from arboleda.wire.hop import FromPlant


@pytest.fixture
def rig() -> Rig:
    made = Rig(shipped("sis_a"))
    made.wait(5.0)
    return made


def test_a_command_with_a_number_beyond_those_given_halts_the_arm_in_mid_carry(rig: Rig) -> None:
    task = rig.submit("sis_a 0B 4").task
    rig.wait_for("sis_a", "main/move to station 4")
    forged = MoveJoints(id=f"{rig.plant.epoch}-9999", robot="ra1", q=(1.0, 0.3, 0.0))
    rig.broker.clients[BRIDGE].inbox.append(FromPlant(at=rig.now, message=forged))
    rig.wait(120.0, until=lambda: rig.plant.at_rest)
    told = str(rig.plant.dispatcher.interference.noticed[0].sentence)
    assert f"ra1: its bridge took command {forged.id}, which this plant never gave" in told
    assert rig.outcomes()[task].state.value == "failed"
    assert told in str(rig.outcomes()[task].sentence)
