"""The driver `ros`: a device by its own actions, services and topics of ROS 2."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from functools import partial
from typing import Any

from arboleda.drivers import Command, DriverError, NotSent, Robot, VerbCommand, driver
from arboleda_drivers.ros_action.action_link import ActionLink
from arboleda_drivers.ros_action.events import Said
from arboleda_drivers.ros_action.interfaces import hear_all, interface
from arboleda_drivers.ros_action.presence import End
from arboleda_drivers.ros_action.ros_driver import RosDriver
from arboleda_drivers.ros_mapping.events import (
    ActionSaid,
    CancelGoals,
    EndsFound,
    GoalRequest,
    MessageHeard,
    Response,
    Send,
)
from arboleda_drivers.ros_mapping.heard_facts import Told
from arboleda_drivers.ros_mapping.keys import Call, Fields, Qos
from arboleda_drivers.ros_mapping.machine import Machine
from arboleda_drivers.ros_mapping.settings import Settings
from arboleda_drivers.ros_mapping.types import message_of


@driver("ros", settings=Settings)
class RosMapping(RosDriver):
    """Driver of one device."""

    def __init__(self, settings: Settings) -> None:
        super().__init__(settings)
        self._actions: dict[End, ActionLink] = {}
        self._clients: dict[End, Any] = {}  # of services, and publishers

    def machine(self, devices: Sequence[Robot]) -> Machine:
        for name in {call.type for _, call in self.settings.calls} | self._topics().keys():
            interface(name)  # what is missing is told before anything is made
        return Machine(devices, self.settings)

    def request(self, command: Command) -> GoalRequest:
        """The event of a command, with the message for a verb, made before anything of it has left."""
        if not isinstance(command, VerbCommand) or command.verb not in self.settings.verbs:
            return GoalRequest(command=command)
        verb = self.settings.verbs[command.verb]
        try:
            payload = self._filled(verb, verb.filled(dict(command.values)))
        except DriverError as error:
            raise NotSent(str(error)) from error
        return GoalRequest(command=command, payload=payload)

    def _filled(self, call: Call, fields: Fields) -> Any:
        return message_of(call, fields, self.node.get_clock().now().to_msg())

    def join(self, node: Any) -> None:
        for _, call in self.settings.calls:
            self._make(self.settings.end(call), call)
        for type, names in self._topics().items():
            for name in names:
                hear_all(node, interface(type), name, partial(self._told, End("topic", name)))

    def _topics(self) -> dict[str, set[str]]:
        """The names of the topics that are heard, by their type."""
        topics: dict[str, set[str]] = {}
        for _, source in self.settings.sources:
            if source.topic:
                topics.setdefault(source.type, set()).add(self.settings.full(source.topic))
        return topics

    def _make(self, end: End, call: Call) -> None:
        """Make what reaches an end, once."""
        type = interface(call.type)
        if end in self._actions or end in self._clients:
            return
        if end.kind == "action":
            take = partial(self._say, end)
            self._actions[end] = ActionLink(self.node, type, end.name, take, self.lose, _whole)
        elif end.kind == "service":
            self._clients[end] = self.node.create_client(type, end.name)
        else:
            self._clients[end] = self.node.create_publisher(type, end.name, _profile(call.qos))

    def do(self, message: CancelGoals | Send) -> None:
        if isinstance(message, CancelGoals):
            self._actions[message.end].cancel_all()
        else:
            self._send(message)

    def _send(self, send: Send) -> None:
        end = self.settings.end(send.call)
        payload = send.payload or self._filled(send.call, send.call.filled({}))
        if end.kind == "action":
            verb = next(name for name, verb in self.settings.verbs.items() if verb is send.call)
            self._actions[end].send(send.id, send.uuid, payload, partial(self._feedback, verb))
        elif end.kind == "service":
            self._clients[end].call_async(payload).add_done_callback(partial(self._responded, send.id))
        else:
            self._clients[end].publish(payload)

    # What comes back, in the thread of ROS 2.

    def _say(self, end: End, said: Said) -> None:
        self.step(ActionSaid(end=end, said=said))

    def _feedback(self, verb: str, message: Any) -> None:
        self._told(("feedback", verb), message.feedback)

    def _told(self, told: Told, message: Any) -> None:
        self.take(message, MessageHeard(told=told, message=message))

    def _responded(self, id: str, future: Any) -> None:
        response = None if future.cancelled() or future.exception() else future.result()
        self.take(response, Response(id=id, message=response))

    def look(self) -> EndsFound:
        found = {end: link.servers().servers for end, link in self._actions.items()}
        found |= {end: self._hearers(end) for end in self._clients}
        for names in self._topics().values():
            found |= {End("topic", name): self._publishers(name) for name in names}
        return EndsFound(found=found)

    def _hearers(self, end: End) -> tuple[int, ...]:
        client = self._clients[end]
        if end.kind == "publish":
            return tuple(range(client.get_subscription_count()))
        ready = client.service_is_ready()
        count = getattr(self.node, "count_services", None)  # Humble has none
        return tuple(range(count(end.name) if count is not None else 1)) if ready else ()

    def _publishers(self, name: str) -> tuple[int, ...]:
        found = self.node.get_publishers_info_by_topic(self.node.resolve_topic_name(name))
        return tuple(sorted(zlib.crc32(bytes(each.endpoint_gid)) for each in found))


def _whole(result: Any) -> dict[str, Any]:
    return {"message": result}


def _profile(qos: Qos) -> Any:
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    return QoSProfile(
        depth=qos.depth,
        reliability=ReliabilityPolicy[qos.reliability.upper()],
        durability=DurabilityPolicy[qos.durability.upper()],
    )
