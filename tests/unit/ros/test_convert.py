"""Commands between plant and bridge, as messages of ROS 2, and those that mean nothing."""

from __future__ import annotations

import math

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

from std_msgs.msg import Float32MultiArray, MultiArrayDimension, UInt8

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.errors import PayloadError
from arboleda.testing import shipped
from arboleda_ros.convert import command, command_message, is_copy, labelled_command, labelled_message

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
@pytest.mark.parametrize("sent", COMMANDS, ids=lambda sent: sent.id)
def test_a_command_comes_with_its_id_and_what_the_plant_had_heard(sent: Command, *, copied: bool) -> None:
    robot = PLANT.robots[sent.robot]
    assert labelled_command(robot, labelled_message(robot, sent, copied=copied))[0] == sent


def test_a_message_that_is_filled_anew_is_as_one_that_is_made() -> None:
    form = Float32MultiArray()
    for sent in (*COMMANDS, *reversed(COMMANDS)):
        robot = PLANT.robots[sent.robot]
        for copied in (True, False):
            made = labelled_message(robot, sent, copied=copied)
            assert labelled_message(robot, sent, copied=copied, into=form) is form
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


def test_an_array_on_a_plain_topic_says_that_it_is_a_copy_and_a_word_cannot() -> None:
    assert is_copy(command_message(COMMANDS[0], copy=True))
    assert not is_copy(command_message(COMMANDS[0]))
    assert not is_copy(command_message(COMMANDS[2], copy=True))


@pytest.mark.parametrize(
    ("labels", "data"),
    [
        ([], [1.0]),
        (["id=7-1"], [1.0]),
        (["id=7-1", "path_cmd"], [1.0]),
        (["7-1", "effector_cmd"], [1.0]),
        (["id=7-1", "effector_cmd"], [1.5]),
        (["id=7-1", "effector_cmd"], [7.0]),
        (["id=7-1", "effector_cmd"], [math.nan]),
        (["id=7-1", "effector_cmd"], []),
    ],
    ids=lambda value: " ".join(map(str, value)) or "none",
)
def test_a_broken_command_with_an_id_is_refused(labels: list[str], data: list[float]) -> None:
    broken = Float32MultiArray(data=data)
    broken.layout.dim = [MultiArrayDimension(label=label, size=len(data), stride=1) for label in labels]
    with pytest.raises(PayloadError):
        labelled_command(PLANT.robots["ra1"], broken)


@pytest.mark.parametrize(
    ("kind", "robot", "message", "why"),
    [
        (MoveJoints, "ra1", Float32MultiArray(data=[1.0, 2.0]), "3 joints, but the goal has 2 numbers"),
        (MoveJoints, "ra1", Float32MultiArray(data=[1.0, math.nan, 0.05]), "only finite numbers"),
        (FollowPath, "rm_sis_a", Float32MultiArray(data=[0.0, 3.5]), "3.5 is no grid node"),
        (FollowPath, "rm_sis_a", Float32MultiArray(data=[0.0, 9.0]), "9 is no grid node"),
        (FollowPath, "rm_sis_a", Float32MultiArray(), "the path is empty"),
        (SetEffector, "ra1", UInt8(data=7), "the value 7 means nothing; allowed: 0, 1"),
        (Stop, "rm_sis_a", UInt8(data=9), "the value 9 means nothing"),
        (Home, "ra1", UInt8(data=0), "the value 0 means nothing; allowed: 1"),
    ],
    ids=["2 of 3 joints", "NaN", "half a node", "node 9", "no node", "effector 7", "stop 9", "home 0"],
)
def test_a_bad_plain_command_is_refused_whole(
    kind: type[Command], robot: str, message: Float32MultiArray | UInt8, why: str
) -> None:
    with pytest.raises(PayloadError, match=why):
        command(kind, PLANT.robots[robot], message)


@pytest.mark.parametrize(("label", "size"), [("id=", 3), ("id=7 1", 3), ("id=7-1", 2)])
def test_a_plain_command_with_a_broken_label_is_refused(label: str, size: int) -> None:
    broken = Float32MultiArray(data=[0.0, 0.0, 0.0])
    broken.layout.dim = [MultiArrayDimension(label=label, size=size, stride=size)]
    with pytest.raises(PayloadError):
        command(MoveJoints, PLANT.robots["ra1"], broken)
