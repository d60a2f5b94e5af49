"""The bridge's side of ROS 2: commands in, what the boards report out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, UInt8, UInt32

from arboleda.core.messages import Command, Heartbeat, Report
from arboleda.core.model import Arm, Link, PlantModel, Robot
from arboleda.wire.bridge import FromPlant
from arboleda.wire.status import ERROR, OK

from . import convert, qos, statuses
from .port import Port


@dataclass(frozen=True, kw_only=True)
class _Voice:
    """The publishers of one robot; only arms have a piece sensor."""

    robot: Robot
    status: Publisher
    state: Publisher
    joints: Publisher
    piece: Publisher | None


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
        self._voices = {robot.name: self._voice(robot) for robot in robots}
        # Discovery keeps the order in which endpoints were made, here and in the orchestrator: a heartbeat
        # that arrives proves that the commands, made before it, arrive too.
        self._listen(UInt32, "plant/heartbeat", self._on_heartbeat, qos.COMMAND)

    def send(self, report: Report) -> None:
        """Publish one report on every topic that carries a part of it."""
        voice = self._voices[report.robot]
        voice.status.publish(statuses.status_of(voice.robot, report))
        if report.state is not None:
            voice.state.publish(UInt8(data=int(report.state)))
        stamp = self._node.get_clock().now().to_msg()
        joints = convert.joint_state(voice.robot, report, stamp)
        if joints is not None:
            voice.joints.publish(joints)
        if voice.piece is not None and report.piece is not None:
            voice.piece.publish(Bool(data=report.piece))

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

    def _voice(self, robot: Robot) -> _Voice:
        is_arm = isinstance(robot, Arm)
        return _Voice(
            robot=robot,
            status=self._speak(DiagnosticStatus, f"{robot.name}/status", qos.COMMAND, alone=True),
            state=self._speak(UInt8, f"{robot.name}/motion_state", qos.COMMAND),
            joints=self._speak(JointState, convert.joint_states_topic(robot), qos.COMMAND),
            piece=self._speak(Bool, f"{robot.name}/piece_detected", qos.COMMAND) if is_arm else None,
        )

    def _on_command(self, kind: type[Command], robot: Robot, message: Any) -> None:
        self._forward(convert.command(kind, robot, message))

    def _on_heartbeat(self, message: UInt32) -> None:
        self._forward(Heartbeat(epoch=message.data))

    def _forward(self, message: Command | Heartbeat) -> None:
        self._on_event(FromPlant(at=self._clock(), message=message))
