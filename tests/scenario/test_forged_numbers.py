"""Commands in the plant's name that it never gave: seen at once, halted, and the next task is done."""

from __future__ import annotations

import json

import pytest

from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Home
from arboleda.model.messages import MotionState
from arboleda.rig.rig import Rig
from arboleda.rig.world import BRIDGE
from arboleda.testing import shipped
from arboleda.wire.hop import FromPlant
from arboleda.wire.transport import Publication


@pytest.fixture
def rig() -> Rig:
    made = Rig(shipped("sis_a"))
    made.wait(5.0)
    return made


def bridge_epoch(rig: Rig) -> int:
    epoch = rig.plant.dispatcher.beliefs["ra1"].epoch
    assert epoch is not None
    return epoch


def others_told(rig: Rig) -> list[str]:
    return [str(each.sentence) for each in rig.plant.dispatcher.interference.noticed]


def beats(epoch: int) -> list[Publication]:
    said = json.dumps({"epoca": epoch}).encode()
    return [Publication(topic=f"{board}/latido", payload=said) for board in ("ra_1", "rm_sis_a")]


def forged_goal(rig: Rig) -> Publication:
    goal = {"q1": 60.0, "q2": 20.0, "q3": 0.0, "seq": 9999, "epoca": bridge_epoch(rig)}
    return Publication(topic="ra_1/juntas", payload=json.dumps(goal).encode())


def ends_well(rig: Rig) -> bool:
    task = rig.submit("sis_a 0B 7 #next").task
    return rig.wait(240.0, until=lambda: rig.outcomes()[task].state.value == "done")


def test_a_forged_goal_before_the_first_command_is_told_halted_and_the_next_task_is_done(rig: Rig) -> None:
    forged = forged_goal(rig)
    rig.inject(forged)
    rig.wait(2.0)
    epoch = json.loads(forged.payload)["epoca"]
    assert others_told(rig) == [
        f"ra1: its board took a command of another MQTT client (epoca {epoch}, seq 9999)"
    ]
    belief = rig.plant.dispatcher.beliefs["ra1"]
    assert belief.q is not None and belief.q[0] < 0.5, "the arm went on its way to 1.05 rad"
    assert ends_well(rig)


def test_a_forged_goal_in_mid_carry_halts_the_arm_names_itself_and_leaves_the_plant_at_work(rig: Rig) -> None:
    task = rig.submit("sis_a 0B 4").task
    rig.wait_for("sis_a", "main/move to station 4")
    rig.inject(forged_goal(rig))
    rig.wait(120.0, until=lambda: rig.outcomes()[task].state.value == "failed")
    (told,) = others_told(rig)
    assert "its board took a command of another MQTT client" in told
    assert told in str(rig.outcomes()[task].sentence)
    home = Home(id=f"{rig.plant.epoch}-800", robot="ra1")
    rig.broker.clients[BRIDGE].inbox.append(FromPlant(at=rig.now, message=home))
    rig.settle()
    assert rig.wait(5.0, until=lambda: rig.boards["ra_1"].state is MotionState.MOVING), "it obeys again"


@pytest.mark.parametrize("seconds", [0.5, 15.0])
def test_a_second_bridge_that_comes_and_goes_is_named_and_the_next_task_is_done(
    rig: Rig, seconds: float
) -> None:
    """It beats until each board says that it takes nothing older, and yields to who rises above it."""
    rig.wait(20.0)
    for beat in beats(bridge_epoch(rig) + 300):
        rig.inject(beat)
    rig.wait(seconds)
    assert sorted(others_told(rig)) == [
        f"{robot}: another bridge has come to its board (epoca {bridge_epoch(rig) + 300}); what this plant "
        "commands next is numbered above it. End the other one"
        for robot in ("ra1", "rm_sis_a")
    ]
    assert ends_well(rig)


def test_a_second_bridge_that_comes_in_mid_carry_is_named_by_what_fails_and_commands_go_on(rig: Rig) -> None:
    """A board ends a motion of which it may no longer take the beats."""
    task = rig.submit("sis_a 0B 4").task
    rig.wait_for("sis_a", "main/move to station 4")
    for beat in beats(bridge_epoch(rig) + 300):
        rig.inject(beat)
    rig.wait(10.0, until=lambda: rig.outcomes()[task].state.value == "failed")
    assert "another bridge has come to its board" in str(rig.outcomes()[task].sentence)
    assert rig.plant.dispatcher.booking.rejected == {}
    home = Home(id=f"{rig.plant.epoch}-800", robot="ra1")
    rig.broker.clients[BRIDGE].inbox.append(FromPlant(at=rig.now, message=home))
    rig.settle()
    assert rig.wait(5.0, until=lambda: rig.boards["ra_1"].state is MotionState.MOVING)


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
