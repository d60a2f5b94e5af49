"""ROS 2 side of the bridge: commands in, reports of the boards out."""

from __future__ import annotations

import json
import math
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from std_msgs.msg import String, UInt32

from arboleda.adapters.rate_limit import RateLimit
from arboleda.drivers import Command, Report, Robot
from arboleda.extension import PayloadError
from arboleda.model.messages import Heartbeat
from arboleda.model.plant_model import Link, PlantModel
from arboleda.wire import epochs, rejections
from arboleda.wire.hop import HEARTBEAT, PLAIN, FromPlant, without_id
from arboleda.wire.rejections import ForeignCommand, Rejection
from arboleda.wire.status import ERROR, OK, WARN
from arboleda_ros import convert, qos, statuses
from arboleda_ros.port import Port
from arboleda_ros.robot_publisher import RobotPublisher
from arboleda_ros.senders import Senders

FAR_AHEAD = (
    "plant %s is far ahead of the clock here (%s): it is obeyed once it has beaten for "
    f"{epochs.BELIEVED_S:g} s, unless this bridge has heard a plant that it cannot follow; "
    "set both clocks if one is wrong, and start the bridge anew if this plant stays refused"
)
NEWS_S = 10.0  # time for which `/diagnostics` warns of somebody else's command


class BridgePort(Port):
    """Node `mqtt_bridge`; `on_event` gets every command for a robot on MQTT, on the link's thread."""

    def __init__(
        self, node: Node, model: PlantModel, on_event: Callable[[FromPlant], None], clock: Callable[[], float]
    ) -> None:
        super().__init__(node, clock)
        self._on_event = on_event
        self._mqtt: DiagnosticStatus | None = None
        self._senders = Senders(node, clock)
        self._far_plants = RateLimit(every_s=math.inf)
        self._rejected: Counter[str] = Counter()
        self._last = ""
        self._last_at = -NEWS_S
        robots = [robot for robot in model.robots.values() if robot.link is Link.MQTT]
        for robot in robots:
            self._obey(robot)
        speak = partial(self.topics.speak, profile=qos.COMMAND)
        self._voices = {robot.name: RobotPublisher(robot, speak, node.get_clock()) for robot in robots}
        self._rejections = {robot.name: speak(String, f"{robot.name}/rejected") for robot in robots}
        # Discovery keeps the order in which endpoints were made, here and in the orchestrator: a heartbeat
        # that arrives proves that the commands, made before it, arrive too.
        self.topics.listen(UInt32, HEARTBEAT, self._on_heartbeat, qos.COMMAND)

    def send(self, report: Report) -> None:
        """Publish one report on every topic that carries a part of it."""
        self._voices[report.robot].say(report)

    def tell(self, news: Rejection | ForeignCommand) -> None:
        """Publish that a command was refused, or that one of somebody else was obeyed."""
        self._last, self._last_at = str(news.sentence), self._clock()
        if isinstance(news, Rejection):
            self._publish_rejection(news)

    def mqtt_link(self, up: bool, broker: str) -> None:
        """Note that the bridge reached or lost its broker; `/diagnostics` tells it at once."""
        name = self._diagnosed(f"{self._node.get_name()} on MQTT")
        level, words = (OK, "connected to") if up else (ERROR, "not connected to")
        sentence = f"{words} the MQTT broker at {broker}"
        self._mqtt = statuses.diagnostic(name, "mqtt", level, sentence, {"broker": broker})
        self._publish_diagnostics([self._mqtt])

    def _links(self) -> list[DiagnosticStatus]:
        return [*([self._mqtt] if self._mqtt is not None else []), self._commands()]

    def _commands(self) -> DiagnosticStatus:
        """The diagnostic status of commands: the number refused, and the last news of one."""
        fresh = self._clock() < self._last_at + NEWS_S
        values = {"rejected": str(self._rejected.total()), "last": self._last}
        name = self._diagnosed(f"{self._node.get_name()} commands")
        return statuses.diagnostic(
            name, "ros", WARN if fresh else OK, self._last if fresh else "ready", values
        )

    def _publish_rejection(self, rejection: Rejection) -> None:
        self._rejected[rejection.robot] += 1
        publisher = self._rejections.get(rejection.robot)
        if publisher is not None:
            plain = {**vars(rejection), "sentence": str(rejection.sentence)}
            del plain["at"]
            plain["count"] = self._rejected[rejection.robot]
            publisher.publish(String(data=json.dumps(plain)))

    def _obey(self, robot: Robot) -> None:
        kind_of_all, of_all = convert.ordered(robot)
        self.topics.listen(kind_of_all, of_all, partial(self._on_labelled, robot, of_all), qos.COMMAND)
        for kind in convert.commands_of(robot):
            if f"{robot.name}/{PLAIN[kind]}" == of_all:
                continue
            handle = partial(self._on_plain, kind, robot)
            self.topics.listen(convert.message_type(kind), f"{robot.name}/{PLAIN[kind]}", handle, qos.COMMAND)

    def _on_labelled(self, robot: Robot, topic: str, message: Any) -> None:
        with self._telling(robot, topic.rpartition("/")[2]):
            command, copied = convert.labelled_command(robot, message)
        sender = "" if command.id else self._senders.of(topic)
        self._on_event(FromPlant(at=self._clock(), message=command, copied=copied, sender=sender))

    def _on_plain(self, kind: type[Command], robot: Robot, message: Any) -> None:
        if convert.is_copy(message):
            return
        with self._telling(robot, PLAIN[kind]):
            # The plant sends ids on `command` only: one on a plain topic proves nothing.
            command = without_id(convert.command(kind, robot, message))
        sender = self._senders.of(f"{robot.name}/{PLAIN[kind]}")
        self._on_event(FromPlant(at=self._clock(), message=command, sender=sender))

    @contextmanager
    def _telling(self, robot: Robot, topic: str) -> Iterator[None]:
        """Context in which a command is read; an unreadable one is published as a refused command."""
        try:
            yield
        except PayloadError as error:
            sentence = rejections.unreadable(robot, topic, error.sentence)
            self.tell(
                Rejection(
                    at=self._clock(),
                    robot=robot.name,
                    command=topic,
                    id="",
                    reason="formato",
                    sentence=sentence,
                )
            )
            raise

    def _on_heartbeat(self, message: UInt32) -> None:
        epoch, at, unix_s = message.data, self._clock(), int(time.time())
        if (never := epochs.objection(epoch, None)) is not None:
            raise PayloadError(never)
        if epochs.objection(epoch, unix_s) is not None and self._far_plants.is_due(epoch, at):
            self.topics.log.warning(FAR_AHEAD, epoch, unix_s)
        self._on_event(FromPlant(at=at, message=Heartbeat(epoch=epoch), unix_s=unix_s))
