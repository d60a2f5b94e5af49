"""A base behind `navigate_to_pose` and `follow_waypoints`."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from arboleda.testing.drivers import Bench
from arboleda.testing.drivers.bench import OTHER, WORK

from ..contract.mover import HOME, Opened, app_of, plant
from ..ros_action.bench import PlayedServer

PLACES = {(0.0, 0.0): HOME, (1.0, 0.0): WORK, (0.0, 1.0): OTHER}


class Base:
    package = "nav2_msgs"
    action = "navigate_to_pose"
    type_name = "NavigateToPose"
    failure = "aborted"

    def __init__(self) -> None:
        self._x, self._y = 0.0, 0.0

    def place(self, goal: Any) -> tuple[float, float]:
        at = goal.pose.pose.position
        return (at.x, at.y)

    def word(self, goal: Any) -> str:
        x, y = self.place(goal)
        return PLACES[(round(x, 3), round(y, 3))]

    def go(self, goal: Any) -> None:
        self._x, self._y = self.place(goal)

    def give_up(self, result: Any) -> None:
        """It says no more than that."""

    def publishers(self, node: Any) -> None:
        from geometry_msgs.msg import PoseWithCovarianceStamped
        from nav_msgs.msg import Odometry
        from rclpy.qos import DurabilityPolicy, QoSProfile

        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._counted = node.create_publisher(Odometry, "odom", 10)
        self._localised = node.create_publisher(PoseWithCovarianceStamped, "amcl_pose", kept)

    def speak(self, stamp: Any) -> None:
        from geometry_msgs.msg import PoseWithCovarianceStamped
        from nav_msgs.msg import Odometry

        for message, publisher in (
            (Odometry(), self._counted),
            (PoseWithCovarianceStamped(), self._localised),
        ):
            message.header.stamp = stamp
            message.pose.pose.position.x, message.pose.pose.position.y = self._x, self._y
            publisher.publish(message)


class Follower(Base):
    action = "follow_waypoints"
    type_name = "FollowWaypoints"

    def place(self, goal: Any) -> tuple[float, float]:
        at = goal.poses[-1].pose.position
        return (at.x, at.y)


def _open(driver: str, body: type[Base], folder: Path, state: Path) -> Opened:
    keys = f"kind: mobile, grid: {{pitch_mm: 1000}}, driver: {{{driver}: {{tolerance_m: 0.1}}}}"
    app = app_of(folder, state, plant("cart", keys, "node", (0, 1, 3)), "cart")
    return app, lambda app: PlayedServer(body())


BENCH = Bench(open=partial(_open, "navigate_to_pose", Base))
WAYPOINTS_BENCH = Bench(open=partial(_open, "follow_waypoints", Follower))
