"""Commands in the plant's name that it never gave: seen at once, halted, and the next task is done."""

from __future__ import annotations

import json

import pytest

from arboleda.kinds.arm import MoveJoints
from arboleda.simulator.world import BRIDGE
from arboleda.testing import shipped
from arboleda.testing.rig import Rig
from arboleda.wire.hop import FromPlant
from arboleda.wire.transport import Publication


@pytest.fixture
def rig() -> Rig:
    made = Rig(shipped("sis_a"))
    made.wait(5.0)
    return made


def forged_goal(epoch: int) -> Publication:
    goal = {"q1": 60.0, "q2": 20.0, "q3": 0.0, "seq": 9999, "epoca": epoch}
    return Publication(topic="ra_1/juntas", payload=json.dumps(goal).encode())


def test_a_forged_goal_before_the_first_command_is_told_and_the_next_task_is_done(rig: Rig) -> None:
    epoch = rig.plant.dispatcher.beliefs["ra1"].epoch
    assert epoch is not None
    rig.inject(forged_goal(epoch))
    rig.wait(2.0)
    told = [str(each.sentence) for each in rig.plant.dispatcher.interference.noticed]
    assert told == [f"ra1: its board took a command of another MQTT client (epoca {epoch}, seq 9999)"]
    belief = rig.plant.dispatcher.beliefs["ra1"]
    assert belief.q is not None and belief.q[0] < 1.0, "the arm went all the way"
    task = rig.submit("sis_a 0B 7 #next").task
    rig.wait(120.0, until=lambda: task in rig.outcomes())
    assert rig.wait(120.0, until=lambda: rig.outcomes()[task].state.value == "done"), rig.outcomes()


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
