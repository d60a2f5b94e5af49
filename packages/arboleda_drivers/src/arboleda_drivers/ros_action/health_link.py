"""Health of a robot over ROS 2: the topic that tells of its stops, and the calls that lead out of them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from operator import attrgetter
from typing import Any

from arboleda_drivers.ros_action.health import Call, CallAnswer, Health, HealthReading
from arboleda_drivers.ros_action.interfaces import hear_all, interface

SUCCEEDED = 4  # action_msgs/msg/GoalStatus
Take = Callable[[Any, HealthReading | CallAnswer], None]


class HealthLink:
    """Link to a robot's health: passes readings and answers to `take`, in the thread of ROS 2."""

    def __init__(self, node: Any, health: Health, take: Take) -> None:
        """Subscribe, and make the clients of all calls; raises DriverError if a type is missing."""
        self._take, self._field = take, attrgetter(health.field)
        hear_all(node, interface(health.type), health.topic, self._read)
        self._clients = {call.name: _client(node, call) for call in health.clear}

    def make(self, call: Call) -> None:
        """Make a call; its answer is taken later."""
        client, type = self._clients[call.name], interface(call.type)
        if not (client.service_is_ready() if call.service else client.server_is_ready()):
            self._answer(call, False, "is not there")
        elif call.service:
            request = _filled(type.Request(), call)
            client.call_async(request).add_done_callback(partial(self._served, call))
        else:
            client.send_goal_async(_filled(type.Goal(), call)).add_done_callback(partial(self._begun, call))

    def _read(self, message: Any) -> None:
        self._take(message, HealthReading(value=self._field(message)))

    def _served(self, call: Call, future: Any) -> None:
        """Take a service's answer by the fields that makers use: `success`, or `ret` with 0 for success."""
        response = future.result()
        ok = bool(getattr(response, "success", getattr(response, "ret", 0) == 0))
        self._answer(call, ok, str(getattr(response, "message", getattr(response, "answer", ""))))

    def _begun(self, call: Call, future: Any) -> None:
        handle = future.result()
        if handle.accepted:
            handle.get_result_async().add_done_callback(partial(self._ended, call))
        else:
            self._answer(call, False, "was refused")

    def _ended(self, call: Call, future: Any) -> None:
        ok = future.result().status == SUCCEEDED
        self._answer(call, ok, "" if ok else "has not succeeded")

    def _answer(self, call: Call, ok: bool, text: str) -> None:
        self._take(text, CallAnswer(call=call, ok=ok, text=text))


def _client(node: Any, call: Call) -> Any:
    from rclpy.action import ActionClient

    if call.service:
        return node.create_client(interface(call.type), call.service)
    return ActionClient(node, interface(call.type), call.action)


def _filled(request: Any, call: Call) -> Any:
    for name, value in call.request.items():
        setattr(request, name, value)
    return request
