"""A bare pass-through between MQTT and ROS 2: parses JSON, fills messages, keeps nothing and checks nothing.

python -m arboleda_bench.floor_bridge PLANT HOST:PORT [--ros-args ...]
"""

from __future__ import annotations

import json
import math
import signal
import socket
import sys
from functools import partial
from pathlib import Path
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from paho.mqtt.client import Client
from paho.mqtt.enums import CallbackAPIVersion
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float32MultiArray, UInt8, UInt32

from arboleda.kinds.arm import Arm
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load
from arboleda.testing.storage_layout import StorageLayout
from arboleda_ros import qos
from arboleda_ros.link import connect

WORDS = ("stopped", "moving")


class Voice:
    """One arm: its telemetry to four topics, its goals to its board."""

    def __init__(self, node: Node, arm: Arm, client: Client) -> None:
        self._node = node
        self._client = client
        self._name, self._mqtt = f"arboleda: {arm.name}", arm.mqtt
        self._joints = list(arm.joint_states.joints)
        self._radii = [joint.pinion_radius_m or 1.0 for joint in arm.joints]
        self._seq = 0
        self._status = node.create_publisher(DiagnosticStatus, f"{arm.name}/status", qos.COMMAND)
        self._state = node.create_publisher(UInt8, f"{arm.name}/motion_state", qos.COMMAND)
        self._positions = node.create_publisher(JointState, arm.joint_states.topic, qos.COMMAND)
        self._piece = node.create_publisher(Bool, f"{arm.name}/piece_detected", qos.COMMAND)
        node.create_subscription(Float32MultiArray, f"{arm.name}/command", self._on_goal, qos.COMMAND)
        client.message_callback_add(f"{arm.mqtt}/sensores", self._on_telemetry)

    def beat(self) -> None:
        self._client.publish(f"{self._mqtt}/latido", json.dumps({"epoca": 1}))

    def _on_telemetry(self, _client: Client, _userdata: Any, message: Any) -> None:
        said = json.loads(message.payload)
        degrees = [said[f"q{number}_mov"] for number in range(1, len(self._joints) + 1)]
        q = [math.radians(value) * radius for value, radius in zip(degrees, self._radii, strict=True)]
        values = {
            "epoch": str(1),
            "plant": str(1),
            "boot_id": str(said["arranque"]),
            "state": str(said["estado"]),
            "q": ",".join(repr(value) for value in q),
            "homed": "true" if said["ref"] else "false",
            "effector": "true" if said["efector"] else "false",
            "piece": "true" if said["pieza"] else "false",
        }
        pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
        words = WORDS[said["estado"]]
        self._status.publish(
            DiagnosticStatus(
                level=b"\0", name=self._name, hardware_id=self._mqtt, message=words, values=pairs
            )
        )
        self._state.publish(UInt8(data=said["estado"]))
        joints = JointState(name=self._joints, position=q)
        joints.header.stamp = self._node.get_clock().now().to_msg()
        self._positions.publish(joints)
        self._piece.publish(Bool(data=bool(said["pieza"])))

    def _on_goal(self, message: Float32MultiArray) -> None:
        self._seq += 1
        degrees = [
            round(math.degrees(value / radius), 4)
            for value, radius in zip(message.data, self._radii, strict=True)
        ]
        goal = {f"q{number}": value for number, value in enumerate(degrees, start=1)}
        self.beat()
        self._client.publish(f"{self._mqtt}/juntas", json.dumps({**goal, "seq": self._seq, "epoca": 1}), 1)


def main(plant: str, broker: str) -> None:
    """Pass everything through until a signal."""
    link = connect(args=sys.argv)
    client = Client(CallbackAPIVersion.VERSION2)
    client.on_socket_open = _no_delay
    client.max_inflight_messages_set(1)
    host, _, port = broker.rpartition(":")
    try:
        _join(link.node("floor"), load(Path(plant)), client)
        link.start()
        client.connect(host, int(port))
        client.loop_start()
        signal.pause()
    except KeyboardInterrupt:
        pass
    finally:
        client.disconnect()
        client.loop_stop()
        link.close()


def _join(node: Node, model: PlantModel, client: Client) -> None:
    voices = [Voice(node, StorageLayout(cell).arm, client) for cell in model.cells]
    client.on_connect = partial(_subscribe, [f"{cell.roles['arm'].mqtt}/sensores" for cell in model.cells])

    def beat(_: UInt32) -> None:
        for voice in voices:
            voice.beat()

    node.create_subscription(UInt32, "plant/heartbeat", beat, qos.COMMAND)


def _subscribe(topics: list[str], client: Client, *_: Any) -> None:
    client.subscribe([(topic, 1) for topic in topics])


def _no_delay(_client: Client, _userdata: Any, sock: Any) -> None:
    sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
