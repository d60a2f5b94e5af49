"""The virtual base over ROS 2, by either of two actions of Nav2."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from arboleda_drivers.nav2.adapter import fill, pose_of
from arboleda_drivers.nav2.localisation import OdometryPose
from arboleda_drivers.nav2.pose import Pose
from arboleda_drivers.nav2.virtual.machine import BaseBody, Drive
from arboleda_drivers.ros_action.events import GoalResult, Measurement
from arboleda_drivers.ros_action.virtual.machine import VirtualServer
from arboleda_drivers.ros_action.virtual.server import ActionController, Protocol
from arboleda_drivers.virtual.faults import Faults


def controller(
    faults: Faults,
    *,
    action: str,
    waypoints: bool,
    odometry: str,
    localisation: str,
    frame: str,
    start: Pose,
    speed: float,
    rate: float,
    lan: bool,
) -> ActionController:
    body = BaseBody(faults, start=start, speed=speed, frame=frame)
    protocol = Protocol(
        package="nav2_msgs",
        type_name="FollowWaypoints" if waypoints else "NavigateToPose",
        goal=_waypoints if waypoints else _pose,
        result=_missed if waypoints else _nothing,
        sensors=lambda node: _sensors(node, odometry, localisation, frame),
    )
    machine = VirtualServer(body, faults, measure_s=1 / rate)
    return ActionController(machine, protocol, action=action, what="the virtual base", lan=lan)


def _pose(goal: Any) -> Drive:
    return Drive(frame=goal.pose.header.frame_id, poses=(pose_of(goal.pose.pose),))


def _waypoints(goal: Any) -> Drive:
    frames = {each.header.frame_id for each in goal.poses}
    frame = frames.pop() if len(frames) == 1 else ", ".join(sorted(frames))
    return Drive(frame=frame, poses=tuple(pose_of(each.pose) for each in goal.poses))


def _nothing(result: Any, end: GoalResult) -> None:
    """Leaves the result empty: one of NavigateToPose without an error has no content."""


def _missed(result: Any, end: GoalResult) -> None:
    from nav2_msgs import msg

    if hasattr(msg, "MissedWaypoint"):  # releases of Nav2 differ
        result.missed_waypoints = [msg.MissedWaypoint(index=each) for each in end.missed]
    elif hasattr(msg, "WaypointStatus"):
        result.missed_waypoints = [msg.WaypointStatus(waypoint_index=each) for each in end.missed]
    else:
        result.missed_waypoints = list(end.missed)


def _sensors(node: Any, odometry: str, localisation: str, frame: str) -> Callable[[Measurement], None]:
    from geometry_msgs.msg import PoseWithCovarianceStamped
    from nav_msgs.msg import Odometry

    from arboleda_ros.qos import VIEW

    counted = node.create_publisher(Odometry, odometry, 10)
    localised = node.create_publisher(PoseWithCovarianceStamped, localisation, VIEW)

    def publish(measurement: Any) -> None:
        counts = isinstance(measurement, OdometryPose)
        message = Odometry(child_frame_id="base_link") if counts else PoseWithCovarianceStamped()
        message.header.frame_id = "odom" if counts else frame
        message.header.stamp.sec, message.header.stamp.nanosec = measurement.stamp
        fill(message.pose.pose, measurement.pose)
        (counted if counts else localised).publish(message)

    return publish
