"""Campaign of an arm with a gripper that carries a part from slot to slot, as in examples/ros2_control."""

from __future__ import annotations

from collections.abc import Collection

from arboleda.model.messages import Reason
from arboleda_drivers.gripper_command import machine as gripper_driver
from arboleda_drivers.gripper_command.machine import Width
from arboleda_drivers.gripper_command.virtual.machine import Grip, GripperBody
from arboleda_drivers.joint_trajectory import machine as arm_driver
from arboleda_drivers.joint_trajectory.machine import Trajectory
from arboleda_drivers.joint_trajectory.virtual.machine import ArmBody, Points

from .ros_action import CAUSES, NO_LINK, ActionRig, Part, near, spot

JOINTS = ("joint1", "joint2", "joint3", "joint4", "joint5", "joint6")
PART_M = 0.04
ARM_CAUSES = {**CAUSES, "no_joint": NO_LINK}
GRIPPER_CAUSES = {
    **CAUSES,
    **{name: {Reason.DEVICE_FAULT} for name in ("lie", "short", "empty", "jam")},
    "stall": {Reason.DEADLINE, Reason.DEVICE_FAULT},
    "slip": {Reason.PART_LOST, Reason.DEVICE_FAULT},
    "allow_stalling": set(),
    "no_joint": NO_LINK,
}


def _arm(faults: Collection[str]) -> ArmBody:
    return ArmBody(JOINTS, faults)


def _points(goal: Trajectory) -> Points:
    return Points(joints=goal.joints, points=((goal.duration_s, goal.q),))


def _gripper(faults: Collection[str]) -> GripperBody:
    return GripperBody("finger_joint", faults, part=PART_M)


def _grip(goal: Width) -> Grip:
    return Grip(position=goal.position, effort=goal.effort)


class CarryRig(ActionRig):
    """Test with a part that a gripper carries; it sees the slot of the arm, and a part in the fingers."""

    work = (("slot_1", True), ("slot_2", True), ("slot_2", False), ("home", False))
    parts = (
        Part(name="arm", machine=arm_driver.machine, body=_arm, read=_points, causes=ARM_CAUSES),
        Part(name="jaw", machine=gripper_driver.machine, body=_gripper, read=_grip, causes=GRIPPER_CAUSES),
    )

    def task(self, number: int) -> str:
        return f"{self.cell.name} carry slot_1 slot_2 #{number}"

    def place(self) -> tuple[str | None, bool]:
        spots = {name: pose.q for name, pose in self.cell.reach["arm"].targets.items()}
        return (
            spot(spots, self.bodies["arm"].position),
            near(self.bodies["jaw"].position, (PART_M,)),
        )
