"""Link to one action server: sends goals and cancels, and passes on what the server says of them."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from functools import partial
from typing import Any

from arboleda_drivers.connections.device_feed import taking
from arboleda_drivers.ros_action.events import (
    CancelAnswer,
    GoalAnswer,
    GoalList,
    GoalResult,
    ListedGoal,
    Said,
    ServersFound,
    Status,
)

REJECTED = 1  # CancelGoal: the server goes on with what it does
STATUSES = {4: Status.SUCCEEDED, 5: Status.CANCELED, 6: Status.ABORTED}
"""The ends of a goal in action_msgs/msg/GoalStatus."""


class ActionLink:
    """Client of one action; all of it runs in the thread of ROS 2."""

    def __init__(
        self,
        node: Any,
        type: Any,
        name: str,
        take: Callable[[Said], object],
        lose: Callable[[str], object],
        end: Callable[[Any], dict[str, Any]],
    ) -> None:
        """`take` gets what the server says; `lose` why that could not be taken; `end` makes the fields of
        GoalResult of a result."""
        from action_msgs.msg import GoalStatusArray
        from action_msgs.srv import CancelGoal
        from rclpy.action import ActionClient
        from rclpy.qos import qos_profile_action_status_default

        self._node, self._take, self._lose, self._end = node, take, lose, end
        self._client = ActionClient(node, type, name)
        self._cancels = node.create_client(CancelGoal, f"{name}/_action/cancel_goal")
        self._status = f"{name}/_action/status"
        latched = qos_profile_action_status_default
        node.create_subscription(GoalStatusArray, self._status, self._list, latched)

    def send(self, id: str, uuid: bytes, goal: Any, feedback: Callable[[Any], object] | None = None) -> None:
        """Send a goal of the action's type; `feedback` gets each message of its progress."""
        from unique_identifier_msgs.msg import UUID

        sent = self._client.send_goal_async(goal, feedback, goal_uuid=UUID(uuid=list(uuid)))
        sent.add_done_callback(partial(self._answered, id))

    def cancel_all(self) -> None:
        from action_msgs.srv import CancelGoal

        # A request without an id and a time means all goals, those of other clients among them.
        self._cancels.call_async(CancelGoal.Request()).add_done_callback(self._cancelled)

    def servers(self) -> ServersFound:
        """The present servers: each publishes the states of its goals by an endpoint of its own."""
        topic = self._node.resolve_topic_name(self._status)
        found = self._node.get_publishers_info_by_topic(topic)
        ready = bool(found) and self._client.server_is_ready()
        gids = sorted(zlib.crc32(bytes(each.endpoint_gid)) for each in found) if ready else ()
        return ServersFound(servers=tuple(gids))

    def _answered(self, id: str, future: Any) -> None:
        handle = future.result()
        with taking(handle, self._lose):
            self._take(GoalAnswer(id=id, accepted=handle.accepted))
        if handle.accepted:
            handle.get_result_async().add_done_callback(partial(self._ended, id))

    def _ended(self, id: str, future: Any) -> None:
        response = future.result()
        status = STATUSES.get(response.status, Status.UNKNOWN)
        with taking(response, self._lose):
            self._take(GoalResult(id=id, status=status, **self._end(response.result)))

    def _list(self, message: Any) -> None:
        with taking(message, self._lose):
            self._take(GoalList(goals=tuple(map(_listed, message.status_list))))

    def _cancelled(self, future: Any) -> None:
        response = future.result()
        with taking(response, self._lose):
            self._take(CancelAnswer(refused=response.return_code == REJECTED))


def _listed(each: Any) -> ListedGoal:
    info = each.goal_info
    stamp = (info.stamp.sec, info.stamp.nanosec)
    return ListedGoal(uuid=bytes(info.goal_id.uuid), stamp=stamp, status=STATUSES.get(each.status))
