"""An arm behind `follow_joint_trajectory`: the services of its action are played by hand in rclpy."""

from __future__ import annotations

import math
import queue
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from arboleda.app.build import App, Options, build
from arboleda.app.config import load

from .bench import HALT, LATCH, OTHER, PATIENCE_S, WORK, Bench, Device, Ref

ACTION = "joint_trajectory_controller/follow_joint_trajectory"
STATE_S = 0.02
HOME = "home"
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6
PATH_TOLERANCE = -4
GOALS = {(0.0,) * 6: HOME, (10.0, 20.0, -30.0, 0.0, 5.0, 0.0): WORK, (5.0, 0.0, 0.0, 0.0, 0.0, 0.0): OTHER}
PLANT = """
name: ros2_control
uses: [recipes.py]
cells:
  shop:
    devices:
      arm:
        kind: arm
        model: cr10a
        driver: {follow_joint_trajectory: {speed_percent: 100}}
    targets:
      home: {arm: {deg: [0, 0, 0, 0, 0, 0]}}
      a: {arm: {deg: [10, 20, -30, 0, 5, 0]}}
      b: {arm: {deg: [5, 0, 0, 0, 0, 0]}}
"""
RECIPES = """
from arboleda.recipes import recipe

@recipe("work")
def work_(cell):
    return cell.device("arm").go("a")

@recipe("other")
def other(cell):
    return cell.device("arm").go("b")
"""


@dataclass(kw_only=True)
class Goal:
    """One goal that the controller was sent; the futures are what its client waits for."""

    q: tuple[float, ...]
    accepted: Any
    ended: Any
    error: int = field(default=0)


class PlayedController:
    """It answers a goal, and ends it, when the test says so; goals that lead home it reaches at once."""

    def __init__(self, joints: list[str]) -> None:
        self._joints, self._q = joints, (0.0,) * len(joints)
        self._orders: queue.Queue[tuple[str, Ref]] = queue.Queue()
        self._goals: dict[bytes, Goal] = {}
        self._homes, self._stop_word, self._last = True, HALT, ""
        self._quiet = threading.Event()
        self._enter()

    def told(self) -> tuple[str, Ref]:
        return self._orders.get(timeout=PATIENCE_S)

    def accepts(self, ref: Ref) -> None:
        self._answer(ref, accepted=True)

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        goal = self._goals[ref]
        self._q = goal.q if there else self._q
        self._end(goal, SUCCEEDED)

    def rejects(self, ref: Ref) -> str:
        self._answer(ref, accepted=False)
        return "goal_refused"

    def gives_up(self, ref: Ref) -> str:
        self._goals[ref].error = PATH_TOLERANCE
        self._end(self._goals[ref], ABORTED)
        return "path_tolerance_violated"

    def rests(self) -> None:
        for goal in list(self._goals.values()):
            self._end(goal, CANCELED)

    def answers(self, ref: Ref, word: str) -> None:
        raise AssertionError("an arm is asked nothing")

    def hush(self) -> None:
        self._quiet.set()

    def boots(self) -> None:
        self._leave()
        self._enter()

    def vanish(self) -> None:
        self._leave()

    def come_back(self) -> None:
        self._homes, self._stop_word = False, LATCH
        self._enter()

    def latches(self) -> None:
        self.rests()

    def close(self) -> None:
        self._leave()

    def _enter(self) -> None:
        from action_msgs.msg import GoalStatusArray
        from action_msgs.srv import CancelGoal
        from control_msgs.action import FollowJointTrajectory
        from rclpy.callback_groups import ReentrantCallbackGroup
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node
        from rclpy.qos import qos_profile_action_status_default
        from sensor_msgs.msg import JointState

        self._goals = {}
        self._context = Context()
        self._context.init()
        node = self._node = Node("controller", context=self._context)
        types = FollowJointTrajectory.Impl
        services = {
            "send_goal": (types.SendGoalService, self._hear_goal),
            "get_result": (types.GetResultService, self._hear_result),
            "cancel_goal": (CancelGoal, self._hear_cancel),
        }
        beside = ReentrantCallbackGroup()  # what waits for the test holds up nothing else
        for name, (kind, hear) in services.items():
            node.create_service(kind, f"{ACTION}/_action/{name}", hear, callback_group=beside)
        node.create_publisher(types.FeedbackMessage, f"{ACTION}/_action/feedback", 10)
        node.create_publisher(GoalStatusArray, f"{ACTION}/_action/status", qos_profile_action_status_default)
        self._states = node.create_publisher(JointState, "joint_states", 10)
        node.create_timer(STATE_S, self._speak)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(node)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._spin, name="controller", daemon=True)
        self._thread.start()

    def _leave(self) -> None:
        if not self._context.ok():
            return
        self._ending.set()
        self._thread.join()
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def _spin(self) -> None:
        while not self._ending.is_set():
            self._executor.spin_once(timeout_sec=STATE_S)

    def _speak(self) -> None:
        from sensor_msgs.msg import JointState

        if not self._quiet.is_set():
            state = JointState(name=self._joints, position=list(self._q))
            state.header.stamp = self._node.get_clock().now().to_msg()
            self._states.publish(state)

    async def _hear_goal(self, request: Any, response: Any) -> Any:
        from rclpy.task import Future

        ref = bytes(request.goal_id.uuid)
        q = tuple(request.goal.trajectory.points[-1].positions)
        goal = self._goals[ref] = Goal(q=q, accepted=Future(), ended=Future())
        name = GOALS[tuple(round(math.degrees(each), 1) for each in q)]
        if name == HOME and self._homes:
            self.accepts(ref)
            self.finishes(ref)
        else:
            self._order(name, ref)
        response.accepted = await goal.accepted
        return response

    async def _hear_result(self, request: Any, response: Any) -> Any:
        goal = self._goals[bytes(request.goal_id.uuid)]
        response.status = await goal.ended
        response.result.error_code = goal.error
        return response

    def _hear_cancel(self, request: Any, response: Any) -> Any:
        if self._last != self._stop_word:  # one stop may take several cancels
            self._order(self._stop_word, None)
        return response

    def _order(self, word: str, ref: Ref) -> None:
        self._last = word
        self._orders.put((word, ref))

    def _answer(self, ref: Ref, *, accepted: bool) -> None:
        self._goals[ref].accepted.set_result(accepted)
        self._executor.wake()

    def _end(self, goal: Goal, status: int) -> None:
        """An action has one end: what would be another is not even sent."""
        if not goal.ended.done():
            goal.ended.set_result(status)
            self._executor.wake()


def _open(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
    folder.mkdir()
    (folder / "plant.yaml").write_text(PLANT, "utf-8")
    (folder / "recipes.py").write_text(RECIPES, "utf-8")
    model = load(folder / "plant.yaml")
    joints = [joint.name for joint in model.robots["arm"].joints]
    app = build(model, ("orchestrator",), Options(state_dir=state))
    return app, lambda app: PlayedController(joints)


BENCH = Bench(open=_open)
