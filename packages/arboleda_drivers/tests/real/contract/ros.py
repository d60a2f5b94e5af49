"""The press on ROS 2 topics."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.shared import need_tool

from arboleda.runtime.build import App
from arboleda.testing.drivers import Bench, Device

from .press import CODES, NAME, STOPS, Order, Press, Words, app_of


def _open(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
    need_tool("rclpy")
    from arboleda_ros.link import connect

    return app_of(folder, state, "ros", link=connect()), lambda app: Press(RosWire)


class RosWire:
    """A robot on ROS 2: verbs on one topic, stops on another, all that it says in `status`."""

    def __init__(self, told: Callable[[Order], None]) -> None:
        from arboleda_ros.link import connect

        self._told, self._connect = told, connect
        self.come_back()

    def say(self, words: Words) -> None:
        from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

        facts = json.dumps({"guard": words.guard})
        said = {"state": str(CODES[words.state].value), "boot_id": str(words.boot), "facts": facts}
        said |= {name: id for name in ("accepted", "done") if (id := getattr(words, name)) is not None}
        if words.rejected is not None:
            said |= {"rejected": words.rejected[0], "reason": words.rejected[1]}
        if words.failed is not None:
            said |= {"failed": words.failed[0], "failure": words.failed[1]}
        if words.answered is not None:
            said |= {"answered": words.answered[0], "answer": json.dumps(words.answered[1])}
        values = [KeyValue(key=key, value=value) for key, value in said.items()]
        message = DiagnosticStatus(name=f"arboleda: {NAME}", hardware_id=NAME, values=values)
        if self._link is not None:
            self._status.publish(message)

    def vanish(self) -> None:
        self._link = self._link.close()

    def come_back(self) -> None:
        from diagnostic_msgs.msg import DiagnosticStatus
        from std_msgs.msg import String, UInt8

        self._link = self._connect()
        node = self._link.node("press_controller")
        self._status = node.create_publisher(DiagnosticStatus, f"{NAME}/status", 10)
        node.create_subscription(String, f"{NAME}/order", self._read, 10)
        node.create_subscription(UInt8, f"{NAME}/stop_cmd", self._read_stop, 10)
        self._link.start()

    def close(self) -> None:
        if self._link is not None:
            self.vanish()

    def _read(self, message: Any) -> None:
        said = json.loads(message.data)
        self._told(Order(ref=said["id"], word=said["verb"]))

    def _read_stop(self, message: Any) -> None:
        self._told(Order(ref=None, word=STOPS[message.data]))


BENCH = Bench(open=_open, asks=True, watches=True)
