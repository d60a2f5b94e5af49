"""Commands between plant and bridge, as messages of ROS 2."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

from std_msgs.msg import Float32MultiArray

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.errors import PayloadError
from arboleda.testing import shipped
from arboleda_ros.convert import command_message, labelled_command, labelled_message

PLANT = shipped("sis_a")
COMMANDS = [
    MoveJoints(id="7-1", robot="ra1", heard=12, q=(0.5, -0.25, 0.0625)),
    FollowPath(id="7-2", robot="rm_sis_a", heard=4294967295, nodes=(0, 3, 4)),
    SetEffector(id="7-3", robot="ra1", heard=0, on=True),
    Home(id="7-4", robot="ra1", heard=12),
    Home(id="7-5", robot="ra1", token="0a3f9x001a01"),
    Stop(id="7-6", robot="ra1", mode=StopMode.HALT),
]


@pytest.mark.parametrize("copied", [False, True])
@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command.id)
def test_a_command_comes_with_its_id_and_what_the_plant_had_heard(command: Command, *, copied: bool) -> None:
    robot = PLANT.robots[command.robot]
    assert labelled_command(robot, labelled_message(robot, command, copied=copied))[0] == command


def test_a_message_that_is_filled_anew_is_as_one_that_is_made() -> None:
    form = Float32MultiArray()
    for command in (*COMMANDS, *reversed(COMMANDS)):
        robot = PLANT.robots[command.robot]
        for copied in (True, False):
            made = labelled_message(robot, command, copied=copied)
            assert labelled_message(robot, command, copied=copied, into=form) is form
            assert form == made
    plain = command_message(COMMANDS[1])
    assert command_message(COMMANDS[1], into=form) is form
    assert form == plain


def test_a_broken_number_is_refused() -> None:
    arm = PLANT.robots["ra1"]
    message = labelled_message(arm, COMMANDS[0], copied=False)
    message.layout.dim[2].label = "heard=-1"
    with pytest.raises(PayloadError, match="heard is '-1'"):
        labelled_command(arm, message)
