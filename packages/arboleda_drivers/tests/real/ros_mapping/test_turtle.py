"""The example of a turtle, against a real action server, service and publisher of rclpy."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from tests.packages import ROOT

pytestmark = pytest.mark.system
STEP_S, STEP = 0.02, 0.1


class Turtle:
    """Names of the first turtle of turtlesim: `rotate_absolute`, `set_pen` and `pose`."""

    def __init__(self) -> None:
        from rclpy.action import ActionServer, CancelResponse
        from turtlesim.action import RotateAbsolute
        from turtlesim.msg import Pose
        from turtlesim.srv import SetPen

        from arboleda_ros.link import connect

        self.theta, self.pens = 0.0, list[int]()
        self._goal: Any = None
        self._link = connect()
        node = self._link.node("turtlesim")
        self._pose, self._result = Pose, RotateAbsolute.Result
        self._poses = node.create_publisher(Pose, "/turtle1/pose", 10)
        node.create_service(SetPen, "/turtle1/set_pen", self._set_pen)
        node.create_timer(STEP_S, self._turn)
        name, accept = "/turtle1/rotate_absolute", lambda handle: CancelResponse.ACCEPT
        self._server = ActionServer(node, RotateAbsolute, name, self._rotate, cancel_callback=accept)
        self._link.start()

    def close(self) -> None:
        self._link.close()

    def _set_pen(self, request: Any, response: Any) -> Any:
        self.pens.append(request.off)
        return response

    def _turn(self) -> None:
        self._poses.publish(self._pose(theta=self.theta))
        if self._goal is None:
            return
        goal, ended = self._goal
        left = goal.request.theta - self.theta
        self.theta += math.copysign(min(STEP, abs(left)), left)
        if goal.is_cancel_requested or abs(left) < STEP:
            self._goal = None
            ended.set_result(goal.canceled if goal.is_cancel_requested else goal.succeed)

    async def _rotate(self, goal: Any) -> Any:
        from rclpy.task import Future

        began, self._goal = self.theta, (goal, Future())
        (await self._goal[1])()
        return self._result(delta=began - self.theta)


@pytest.fixture
def turtle(ros_domain: int, quick_discovery: None) -> Iterator[Turtle]:
    played = Turtle()
    yield played
    played.close()


def test_a_turtle_faces_where_it_is_told_without_a_line_of_python(
    turtle: Turtle, arboleda: Callable[..., Any]
) -> None:
    plant = str(ROOT / "examples/turtle/pond.yaml")
    up = arboleda("up", "--once", "pond 1.5", "--plant", plant, "--boards", "drivers")
    up.wait_for("done      pond 1.5")
    assert up.wait() == 0, up.output
    assert turtle.theta == pytest.approx(1.5, abs=0.03) and turtle.pens == [1, 0]
