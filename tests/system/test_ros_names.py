"""Names and namespaces of the three nodes can be remapped; virtual_devices can bring the broker."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from .conftest import paths

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy")]

EMBEDDED = """
import sys
from arboleda.runtime.parts import broker
broker.MQTT_PORT = {port}  # stands for 1883, which may be taken on this machine
from arboleda_ros import nodes
sys.exit(nodes.main("virtual_devices"))
"""


@pytest.fixture
def plant(start: Callable[..., Any], free_port: int, tmp_path: Path) -> Callable[..., list[Any]]:
    """`plant("-r", "__ns:=/plant2")`: the three nodes, each started with these words after --ros-args."""

    def go(*words: str) -> list[Any]:
        broker = f"broker:=127.0.0.1:{free_port}"
        own = {
            "virtual_devices": ("-p", "broker:=embedded", "-p", "rate:=5"),
            "mqtt_bridge": ("-p", broker),
            "orchestrator": ("-p", f"state_dir:={tmp_path}"),
        }
        programs = {name: ("-m", "arboleda_ros.nodes", name) for name in own}
        programs["virtual_devices"] = ("-c", EMBEDDED.format(port=free_port))
        return [
            start(
                sys.executable,
                *programs[name],
                "--ros-args",
                *more,
                *(word.replace("NAME", f"my_{name}") for word in words),
                env={"PYTHONPATH": paths()},
            )
            for name, more in own.items()
        ]

    return go


def names(observer: Any) -> set[str]:
    """Every topic and service of other nodes, those aside that rclpy itself makes."""
    known = observer.node.get_topic_names_and_types() + observer.node.get_service_names_and_types()
    mine = ("/observer/", "/parameter_events", "/rosout")
    return {name for name, _ in known if not name.startswith(mine)}


def test_a_plant_in_a_namespace_of_its_own_works_there_and_another_beside_it(
    plant: Callable[..., Any], start: Callable[..., Any], observer: Any, tmp_path: Path
) -> None:
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import String

    nodes = plant("-r", "__ns:=/plant2", "-r", "__node:=NAME")
    latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    observer.listen(String, "/plant2/task_status", qos=latched)
    observer.publisher(String, "/plant2/task_request").publish(String(data="sis_a 0B 7"))

    def done() -> bool:
        lines = [json.loads(message.data) for message in observer.heard["/plant2/task_status"]]
        return "done" in [line["state"] for line in lines]

    observer.wait(done, "the task was not done")
    assert {
        (name, space) for name, space in observer.node.get_node_names_and_namespaces() if space != "/"
    } == {("my_orchestrator", "/plant2"), ("my_mqtt_bridge", "/plant2"), ("my_virtual_devices", "/plant2")}
    assert {name for name in names(observer) if not name.startswith("/plant2/")} == {"/diagnostics"}
    words = ("-r", "__ns:=/north", "-p", f"state_dir:={tmp_path / 'north'}")
    command = (sys.executable, "-m", "arboleda_ros.nodes", "orchestrator", "--ros-args", *words)
    nodes.append(start(*command, env={"PYTHONPATH": paths()}))
    nodes[-1].wait_for("MQTT broker: ")
    both = {"/plant2/ra1/joint_goals_q", "/north/ra1/joint_goals_q"}
    observer.wait(lambda: both <= names(observer), "one of the plants does not speak")
    for process in nodes:
        assert process.interrupt() == 0, process.output
        assert "Traceback" not in process.output
