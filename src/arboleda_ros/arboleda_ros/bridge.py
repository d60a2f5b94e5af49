"""The bridge's side of ROS 2: commands in, what the boards report out."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from std_msgs.msg import UInt32

from arboleda.core.messages import Command, Heartbeat, Report
from arboleda.core.model import Link, PlantModel, Robot
from arboleda.wire.bridge import FromPlant
from arboleda.wire.status import ERROR, OK

from . import convert, qos, statuses
from .port import Port
from .voice import Voice


class BridgePort(Port):
    """Node `mqtt_bridge`: `on_event` gets every command for a robot on MQTT, on the link's thread."""

    def __init__(
        self, node: Node, model: PlantModel, on_event: Callable[[FromPlant], None], clock: Callable[[], float]
    ) -> None:
        super().__init__(node, clock)
        self._on_event = on_event
        self._mqtt: DiagnosticStatus | None = None
        robots = [robot for robot in model.robots.values() if robot.link is Link.MQTT]
        for robot in robots:
            self._obey(robot)
        speak = partial(self._speak, profile=qos.COMMAND)
        self._voices = {robot.name: Voice(robot, speak, node.get_clock()) for robot in robots}
        # Discovery keeps the order in which endpoints were made, here and in the orchestrator: a heartbeat
        # that arrives proves that the commands, made before it, arrive too.
        self._listen(UInt32, "plant/heartbeat", self._on_heartbeat, qos.COMMAND)

    def send(self, report: Report) -> None:
        """Publish one report on every topic that carries a part of it."""
        self._voices[report.robot].say(report)

    def mqtt_link(self, up: bool, broker: str) -> None:
        """The bridge has reached or lost its broker; `/diagnostics` says so at once, then with the rest."""
        name = f"arboleda: {self._node.get_name()} on MQTT"
        level, words = (OK, "connected to") if up else (ERROR, "not connected to")
        sentence = f"{words} the MQTT broker at {broker}"
        self._mqtt = statuses.diagnostic(name, "mqtt", level, sentence, {"broker": broker})
        self._publish_diagnostics([self._mqtt])

    def _links(self) -> list[DiagnosticStatus]:
        return [self._mqtt] if self._mqtt is not None else []

    def _obey(self, robot: Robot) -> None:
        for kind in convert.commands_of(robot):
            topic = f"{robot.name}/{convert.COMMAND_TOPICS[kind]}"
            self._listen(
                convert.message_type(kind), topic, partial(self._on_command, kind, robot), qos.COMMAND
            )

    def _on_command(self, kind: type[Command], robot: Robot, message: Any) -> None:
        self._forward(convert.command(kind, robot, message))

    def _on_heartbeat(self, message: UInt32) -> None:
        self._forward(Heartbeat(epoch=message.data))

    def _forward(self, message: Command | Heartbeat) -> None:
        self._on_event(FromPlant(at=self._clock(), message=message))
