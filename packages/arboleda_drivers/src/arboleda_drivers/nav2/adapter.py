"""The drivers `navigate_to_pose` and `follow_waypoints`, for bases that Nav2 drives."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from arboleda.drivers import Robot, driver
from arboleda_drivers.nav2.localisation import MapPose, OdometryPose
from arboleda_drivers.nav2.machine import Route, to_pose, waypoints
from arboleda_drivers.nav2.pose import Pose
from arboleda_drivers.nav2.settings import ToPose, Waypoints
from arboleda_drivers.ros_action.action_client import ActionClientDriver, stamp_of
from arboleda_drivers.ros_action.interfaces import hear_all
from arboleda_drivers.ros_action.machine import Machine


class _Nav2(ActionClientDriver):
    """Base of both drivers of Nav2: it measures the pose of the base."""

    package = "nav2_msgs"

    def listen(self, node: Any) -> None:
        from geometry_msgs.msg import PoseWithCovarianceStamped
        from nav_msgs.msg import Odometry

        from arboleda_ros.qos import SENSOR

        node.create_subscription(Odometry, self.settings.odometry, self._count, SENSOR)
        if self.settings.localisation:
            hear_all(node, PoseWithCovarianceStamped, self.settings.localisation, self._localise)

    def _count(self, message: Any) -> None:
        self.see(OdometryPose(stamp=stamp_of(message), pose=pose_of(message.pose.pose)))

    def _localise(self, message: Any) -> None:
        self.see(MapPose(stamp=stamp_of(message), pose=pose_of(message.pose.pose)))


@driver("navigate_to_pose", settings=ToPose)
class NavigateToPose(_Nav2):
    """Driver of one base; each node of a way is a goal of its own."""

    type_name = "NavigateToPose"

    def mover(self, devices: Sequence[Robot]) -> Machine:
        return to_pose(devices, self.settings)

    def goal(self, action: Any, goal: Route) -> Any:
        (pose,) = goal.poses
        return action.Goal(pose=stamped(pose, goal.frame))

    def end(self, result: Any) -> dict[str, Any]:
        return error_of(result)


@driver("follow_waypoints", settings=Waypoints)
class FollowWaypoints(_Nav2):
    """Driver of one base; all nodes of a way are one goal."""

    type_name = "FollowWaypoints"

    def mover(self, devices: Sequence[Robot]) -> Machine:
        return waypoints(devices, self.settings)

    def goal(self, action: Any, goal: Route) -> Any:
        return action.Goal(poses=[stamped(pose, goal.frame) for pose in goal.poses])

    def end(self, result: Any) -> dict[str, Any]:
        return {**error_of(result), "missed": tuple(map(index_of, result.missed_waypoints))}


def error_of(result: Any) -> dict[str, Any]:
    """The number and text of an error; not every release of Nav2 has the text."""
    return {"error": getattr(result, "error_code", 0), "text": getattr(result, "error_msg", "")}


def index_of(missed: Any) -> int:
    """The number in a value: releases of Nav2 send a number, or a message that has one."""
    return int(getattr(missed, "index", getattr(missed, "waypoint_index", missed)))


def pose_of(pose: Any) -> Pose:
    """The pose on the floor; the yaw of an invalid orientation is NaN."""
    turned = pose.orientation
    # Products, not powers: a power that is too large for a number raises.
    across = turned.w * turned.z + turned.x * turned.y
    along = turned.y * turned.y + turned.z * turned.z
    length = turned.x * turned.x + turned.w * turned.w + along
    yaw = math.atan2(2 * across, 1 - 2 * along) if abs(length - 1) < 0.1 else math.nan
    return Pose(pose.position.x, pose.position.y, yaw)


def stamped(pose: Pose, frame: str) -> Any:
    """A pose as a message without a time, which means now."""
    from geometry_msgs.msg import PoseStamped

    message = PoseStamped()
    message.header.frame_id = frame
    fill(message.pose, pose)
    return message


def fill(message: Any, pose: Pose) -> None:
    """Fill a message with a pose."""
    message.position.x, message.position.y = pose.x, pose.y
    message.orientation.z, message.orientation.w = math.sin(pose.yaw / 2), math.cos(pose.yaw / 2)
