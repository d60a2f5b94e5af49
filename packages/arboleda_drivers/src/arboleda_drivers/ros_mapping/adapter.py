"""The driver `ros`: a device by its own actions, services and topics of ROS 2."""

from __future__ import annotations

import threading
import zlib
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from arboleda.drivers import Clock, Command, DriverError, Hear, NotSent, Report, Robot, VerbCommand, driver
from arboleda_drivers.connections.device_feed import taking
from arboleda_drivers.connections.link import CommandNotSent
from arboleda_drivers.ros_action.action_client import LOOK_S
from arboleda_drivers.ros_action.action_link import ActionLink
from arboleda_drivers.ros_action.events import Said, UnusableMessage
from arboleda_drivers.ros_action.interfaces import interface
from arboleda_drivers.ros_mapping.events import (
    ActionSaid,
    CancelGoals,
    EndsFound,
    Event,
    GoalRequest,
    Message,
    MessageHeard,
    Response,
    Send,
)
from arboleda_drivers.ros_mapping.heard_facts import Told
from arboleda_drivers.ros_mapping.keys import Call, End, Fields, Qos
from arboleda_drivers.ros_mapping.machine import Machine
from arboleda_drivers.ros_mapping.settings import Settings
from arboleda_drivers.ros_mapping.types import message_of


@driver("ros", settings=Settings)
class RosMapping:
    """Driver of one device. All of ROS 2 is done in one thread of its link."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._lock = threading.Lock()  # around the machine and what it reports
        self._link: Any = None
        self._actions: dict[End, ActionLink] = {}
        self._clients: dict[End, Any] = {}  # of services, and publishers

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        self._hear, self._clock = hear, clock
        self._machine = Machine(devices, self._settings)
        for name in {call.type for _, call in self._settings.calls} | self._topics().keys():
            interface(name)  # what is missing is told before anything is made
        from arboleda_ros.link import connect

        self._link = connect(lan=self._settings.lan)
        self._join(self._link.node(f"{devices[0].name}_driver"))
        self._link.start()

    def send(self, command: Command) -> None:
        request = GoalRequest(command=command, payload=self._payload(command))
        for message in self._step(request):
            if isinstance(message, CommandNotSent):
                raise NotSent(message.why)

    def stop(self) -> None:
        if self._link is not None:
            self._link.close()

    def _payload(self, command: Command) -> Any:
        """The message for a verb, made before anything of it has left."""
        if not isinstance(command, VerbCommand) or command.verb not in self._settings.verbs:
            return None
        verb = self._settings.verbs[command.verb]
        try:
            return self._filled(verb, verb.filled(dict(command.values)))
        except DriverError as error:
            raise NotSent(str(error)) from error

    def _filled(self, call: Call, fields: Fields) -> Any:
        return message_of(call, fields, self._node.get_clock().now().to_msg())

    def _join(self, node: Any) -> None:
        from rclpy.clock import Clock as RosClock
        from rclpy.clock import ClockType

        self._node = node
        for _, call in self._settings.calls:
            self._make(self._settings.end(call), call)
        for type, names in self._topics().items():
            for name in names:
                self._subscribe(interface(type), name)
        node.create_timer(LOOK_S, self._look, clock=RosClock(clock_type=ClockType.STEADY_TIME))

    def _topics(self) -> dict[str, set[str]]:
        """The names of the topics that are heard, by their type."""
        topics: dict[str, set[str]] = {}
        for _, source in self._settings.sources:
            if source.topic:
                topics.setdefault(source.type, set()).add(self._settings.full(source.topic))
        return topics

    def _make(self, end: End, call: Call) -> None:
        """Make what reaches an end, once."""
        type = interface(call.type)
        if end in self._actions or end in self._clients:
            return
        if end.kind == "action":
            take = partial(self._say, end)
            self._actions[end] = ActionLink(self._node, type, end.name, take, self._lose, _whole)
        elif end.kind == "service":
            self._clients[end] = self._node.create_client(type, end.name)
        else:
            self._clients[end] = self._node.create_publisher(type, end.name, _profile(call.qos))

    def _subscribe(self, type: Any, name: str) -> None:
        from arboleda_ros.qos import SENSOR, VIEW

        # One hears publishers of any quality of service, the other the last value of those that keep it.
        for profile in (SENSOR, VIEW):
            self._node.create_subscription(type, name, partial(self._told, End("topic", name)), profile)

    def _step(self, *events: Event) -> list[Message]:
        with self._lock:
            messages = self._machine.step(self._clock(), events)
            for message in messages:
                if isinstance(message, Report):
                    self._hear(message)
                elif isinstance(message, CancelGoals):
                    self._later(self._actions[message.end].cancel_all)
                elif isinstance(message, Send):
                    self._later(partial(self._send, message))
        return messages

    def _lose(self, why: str) -> None:
        self._step(UnusableMessage(why=why))

    def _later(self, what: Callable[[], object]) -> None:
        """Call a function in the thread of ROS 2, as its clients are not thread-safe."""
        self._node.executor.create_task(what)

    # What leaves, in the thread of ROS 2.

    def _send(self, send: Send) -> None:
        end = self._settings.end(send.call)
        payload = send.payload or self._filled(send.call, send.call.filled({}))
        if end.kind == "action":
            verb = next(name for name, verb in self._settings.verbs.items() if verb is send.call)
            self._actions[end].send(send.id, send.uuid, payload, partial(self._feedback, verb))
        elif end.kind == "service":
            self._clients[end].call_async(payload).add_done_callback(partial(self._responded, send.id))
        else:
            self._clients[end].publish(payload)

    # What comes back, in the thread of ROS 2.

    def _say(self, end: End, said: Said) -> None:
        self._step(ActionSaid(end=end, said=said))

    def _feedback(self, verb: str, message: Any) -> None:
        self._told(("feedback", verb), message.feedback)

    def _told(self, told: Told, message: Any) -> None:
        with taking(message, self._lose):
            self._step(MessageHeard(told=told, message=message))

    def _responded(self, id: str, future: Any) -> None:
        response = None if future.cancelled() or future.exception() else future.result()
        with taking(response, self._lose):
            self._step(Response(id=id, message=response))

    def _look(self) -> None:
        """Look who is at the other ends."""
        found = {end: link.servers().servers for end, link in self._actions.items()}
        found |= {end: self._hearers(end) for end in self._clients}
        for names in self._topics().values():
            found |= {End("topic", name): self._publishers(name) for name in names}
        self._step(EndsFound(found=found))

    def _hearers(self, end: End) -> tuple[int, ...]:
        client = self._clients[end]
        if end.kind == "publish":
            return tuple(range(client.get_subscription_count()))
        ready = client.service_is_ready()
        count = getattr(self._node, "count_services", None)  # Humble has none
        return tuple(range(count(end.name) if count is not None else 1)) if ready else ()

    def _publishers(self, name: str) -> tuple[int, ...]:
        found = self._node.get_publishers_info_by_topic(self._node.resolve_topic_name(name))
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
