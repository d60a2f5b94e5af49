"""Both ends of a bridge between MQTT and ROS 2: the boards of its arms, and the plant that commands them."""

from __future__ import annotations

import json
import math
import socket
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from paho.mqtt.client import Client, MQTTMessage
from paho.mqtt.enums import CallbackAPIVersion
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.serialization import deserialize_message
from std_msgs.msg import UInt32

from arboleda.drivers import MotionState, MoveJoints
from arboleda.kinds.arm import Arm
from arboleda.wire.payloads import Telemetry, encode
from arboleda_ros import convert, qos

from .flow import NUMBERS, Flow

PLANT_EPOCH = 1000
BEAT_S = 0.25
WORD_S = 0.5  # between two words of a board of which nothing is measured; silent, it would count as gone
WAKE_S = 0.2  # for boards that were silent to count as there again
DEG = 0.1  # between the first joint of one message and that of the next


class Ends:
    """The ends of the bridge at `broker` that works in the ROS 2 namespace `space`, "" or "name/".

    `telemetry` leads from the boards to ROS 2, `goals` from ROS 2 to the boards.
    """

    def __init__(self, node: Node, arms: Sequence[Arm], broker: str, space: str) -> None:
        self._arms = {arm.name: arm for arm in arms}
        self._voices = {arm.name: _goals_of(node, arm, space) for arm in arms}
        self._heart = node.create_publisher(UInt32, f"{space}plant/heartbeat", qos.COMMAND)
        names = tuple(self._arms)
        self.telemetry = Flow(names, send=self._tell, pump=time.sleep, number_of=_number_of_status)
        self.goals = Flow(
            names, send=self._command, pump=self._pump, number_of=_number_of_goal, wake_s=WAKE_S
        )
        self._due = dict.fromkeys((self._beat, self._all_tell), 0.0)
        self._word = 0
        for arm in arms:  # as bytes: to unpack them takes longer than all that a bridge does
            hear = partial(self.telemetry.arrive, arm.name)
            node.create_subscription(
                DiagnosticStatus, f"{space}{arm.name}/status", hear, qos.COMMAND, raw=True
            )
        self._boards = _client(broker)
        for arm in arms:
            self._boards.message_callback_add(f"{arm.mqtt}/juntas", partial(self._obey, arm.name))
            self._boards.subscribe(f"{arm.mqtt}/juntas", 0)
            self._boards.publish(f"{arm.mqtt}/conexion", b"1", 1, retain=True)

    def open(self, check: Callable[[], None]) -> None:
        """Wait until messages come through both ways."""
        self.telemetry.open(check)
        self.goals.open(check)

    def close(self) -> None:
        self._boards.disconnect()

    def _tell(self, name: str, number: int) -> None:
        """Publish a board's report that its arm has moved on."""
        self._word += 1
        first = number % NUMBERS * DEG
        said = Telemetry(
            state=MotionState.MOVING,
            q_deg=(first, -first / 2, first / 4),
            node=None,
            seq=self._word,
            boot_id=1,
            homed=True,
            effector=False,
            piece=False,
        )
        self._boards.publish(f"{self._arms[name].mqtt}/sensores", encode(said))

    def _command(self, name: str, number: int) -> None:
        """Publish a goal of the plant."""
        goal = MoveJoints(
            id=f"{PLANT_EPOCH}-{number}", robot=name, q=(math.radians(number % NUMBERS * DEG), 0.1, 0.01)
        )
        self._voices[name].publish(convert.labelled_message(self._arms[name], goal, copied=False))

    def _obey(self, name: str, _client: Client, _userdata: Any, message: MQTTMessage) -> None:
        self.goals.arrive(name, message.payload)

    def _pump(self, seconds: float) -> None:
        """Receive as boards for a while; plant and boards show now and then that they are there."""
        now = time.monotonic()
        for act, due in self._due.items():
            if now >= due:
                self._due[act] = now + (BEAT_S if act == self._beat else WORD_S)
                act()
        self._boards.loop(seconds)

    def _beat(self) -> None:
        self._heart.publish(UInt32(data=PLANT_EPOCH))

    def _all_tell(self) -> None:
        for name in self._arms:
            self._tell(name, 0)


def _goals_of(node: Node, arm: Arm, space: str) -> Publisher:
    kind, topic = convert.ordered(arm)
    return node.create_publisher(kind, f"{space}{topic}", qos.COMMAND)


def _number_of_status(raw: bytes) -> int:
    values = {pair.key: pair.value for pair in deserialize_message(raw, DiagnosticStatus).values}
    return round(math.degrees(float(values["q"].partition(",")[0])) / DEG)


def _number_of_goal(raw: bytes) -> int:
    return round(float(json.loads(raw)["q1"]) / DEG)


def _client(broker: str) -> Client:
    """A client that writes where it is called, and reads in `loop`; with keepalive 0 it may be silent."""
    client = Client(CallbackAPIVersion.VERSION2)
    client.on_socket_open = _no_delay
    host, _, port = broker.rpartition(":")
    client.connect(host, int(port), 0)
    while not client.is_connected():
        client.loop()
    return client


def _no_delay(_client: Client, _userdata: Any, sock: Any) -> None:
    sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
