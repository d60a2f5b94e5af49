"""A device behind an action of ROS 2: the services of the action are played by hand in rclpy."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Protocol

from arboleda.testing.drivers.bench import LATCH, Ref

from ..contract.mover import HOME, PlayedMover

STATE_S = 0.02
UNKNOWN, SUCCEEDED, CANCELED, ABORTED = 0, 4, 5, 6


class Body(Protocol):
    """Body that the action moves, and the topic that shows its place."""

    package: str
    action: str
    type_name: str
    failure: str  # what the plant must say of a goal that the server gives up

    def word(self, goal: Any) -> str:
        """The order that a goal is."""

    def go(self, goal: Any) -> None:
        """It stands where the goal leads."""

    def give_up(self, result: Any) -> None:
        """Say why in the result."""

    def publishers(self, node: Any) -> None:
        """Make what `speak` publishes with."""

    def speak(self, stamp: Any) -> None:
        """Publish what is measured now."""


@dataclass(kw_only=True)
class Goal:
    """One goal that the server was sent; the futures are what its client waits for."""

    goal: Any
    accepted: Any
    ended: Any
    failed: bool = False


class PlayedServer(PlayedMover):
    """It answers a goal, and ends it, when the test says so; goals that lead home it reaches at once."""

    def __init__(self, body: Body) -> None:
        self._body = body
        super().__init__()
        self._goals: dict[bytes, Goal] = {}
        self._last = ""
        self._quiet = threading.Event()
        self._enter()

    def accepts(self, ref: Ref) -> None:
        self._answer(ref, accepted=True)

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        goal = self._goals[ref]
        if there:
            self._body.go(goal.goal)
        self._end(goal, SUCCEEDED)

    def rejects(self, ref: Ref) -> str:
        self._answer(ref, accepted=False)
        return "goal_refused"

    def gives_up(self, ref: Ref) -> str:
        self._goals[ref].failed = True
        self._end(self._goals[ref], ABORTED)
        return self._body.failure

    def rests(self) -> None:
        for goal in list(self._goals.values()):
            self._end(goal, CANCELED)

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

    def close(self) -> None:
        self._leave()

    def _enter(self) -> None:
        from action_msgs.msg import GoalStatusArray
        from action_msgs.srv import CancelGoal
        from rclpy.callback_groups import ReentrantCallbackGroup
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node
        from rclpy.qos import qos_profile_action_status_default

        self._goals = {}
        self._context = Context()
        self._context.init()
        node = self._node = Node("controller", context=self._context)
        action = self._body.action
        types = getattr(import_module(f"{self._body.package}.action"), self._body.type_name).Impl
        services = {
            "send_goal": (types.SendGoalService, self._hear_goal),
            "get_result": (types.GetResultService, self._hear_result),
            "cancel_goal": (CancelGoal, self._hear_cancel),
        }
        beside = ReentrantCallbackGroup()  # what waits for the test holds up nothing else
        for name, (kind, hear) in services.items():
            node.create_service(kind, f"{action}/_action/{name}", hear, callback_group=beside)
        node.create_publisher(types.FeedbackMessage, f"{action}/_action/feedback", 10)
        node.create_publisher(GoalStatusArray, f"{action}/_action/status", qos_profile_action_status_default)
        self._body.publishers(node)
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
        if not self._quiet.is_set():
            self._body.speak(self._node.get_clock().now().to_msg())

    async def _hear_goal(self, request: Any, response: Any) -> Any:
        from rclpy.task import Future

        ref = bytes(request.goal_id.uuid)
        goal = self._goals[ref] = Goal(goal=request.goal, accepted=Future(), ended=Future())
        word = self._body.word(request.goal)
        if word == HOME and self._homes:
            self.accepts(ref)
            self.finishes(ref)
        else:
            self._order(word, ref)
        response.accepted = await goal.accepted
        return response

    async def _hear_result(self, request: Any, response: Any) -> Any:
        goal = self._goals.get(bytes(request.goal_id.uuid))
        if goal is None:  # sent before it booted
            response.status = UNKNOWN
            return response
        response.status = await goal.ended
        if goal.failed:
            self._body.give_up(response.result)
        return response

    def _hear_cancel(self, request: Any, response: Any) -> Any:
        if self._last != self._stop_word:  # one stop may take several cancels
            self._order(self._stop_word, None)
        return response

    def _order(self, word: str, ref: Ref) -> None:
        self._last = word
        self.orders.put((word, ref))

    def _answer(self, ref: Ref, *, accepted: bool) -> None:
        self._goals[ref].accepted.set_result(accepted)
        self._executor.wake()

    def _end(self, goal: Goal, status: int) -> None:
        """An action has one end: what would be another is not even sent."""
        if not goal.ended.done():
            goal.ended.set_result(status)
            self._executor.wake()
