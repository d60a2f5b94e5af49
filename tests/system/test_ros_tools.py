"""What people already have keeps working: other ROS 2 processes beside `arboleda up`."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy")]

BY_HAND = Path(__file__).parents[2] / "examples/plants/by_hand.yaml"


def states(observer: Any) -> list[str]:
    return [json.loads(message.data)["state"] for message in observer.heard["/task_status"]]


def latched() -> Any:
    from rclpy.qos import DurabilityPolicy, QoSProfile

    return QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def test_a_task_request_from_another_process_shows_on_the_topics_and_a_second_plant_is_refused(
    arboleda: Callable[..., Any], observer: Any, tmp_path: Path
) -> None:
    from diagnostic_msgs.msg import DiagnosticArray
    from sensor_msgs.msg import JointState
    from std_msgs.msg import Float32MultiArray, String, UInt8

    up = arboleda("up", "--rate", "5")
    observer.listen(String, "/task_status", qos=latched())
    observer.listen(Float32MultiArray, "/ra1/joint_goals_q", "/rm_sis_a/path_cmd")
    observer.listen(JointState, "/r1/joint_states", "/rm_sis_a/joint_states")
    observer.listen(UInt8, "/ra1/effector_cmd", "/ra1/motion_state", "/system/start")
    observer.listen(DiagnosticArray, "/diagnostics")
    requests = observer.publisher(String, "/task_request")
    observer.wait(lambda: observer.heard["/r1/joint_states"], "no joint states")
    requests.publish(String(data="sis_a 0B 7"))
    observer.wait(lambda: "done" in states(observer), "the task was not done")
    requests.publish(String(data="sis_a 0B 99"))
    observer.wait(lambda: "refused" in states(observer), "the wrong text was not refused")

    heard = observer.heard
    assert states(observer) == ["queued", "running", "done", "refused"]
    assert [list(message.data) for message in heard["/rm_sis_a/path_cmd"]] == [[0, 3, 4, 7]]
    goals = [[round(value, 2) for value in message.data] for message in heard["/ra1/joint_goals_q"]]
    assert goals == [[0.79, 0.17, 0.0], [0.17, 0.35, 0.1], [0.0, 0.0, 0.0]]
    assert [message.data for message in heard["/ra1/effector_cmd"]] == [1, 0]
    assert [message.data for message in heard["/system/start"]] == [1]
    assert {0, 1} <= {message.data for message in heard["/ra1/motion_state"]}
    assert set(heard["/r1/joint_states"][0].name) == {
        "r1_brazo_joint",
        "r1_antebrazo_joint",
        "r1_efector_joint",
    }
    assert max(message.position[0] for message in heard["/r1/joint_states"]) == pytest.approx(0.785, abs=0.01)
    names = {status.name for message in heard["/diagnostics"] for status in message.status}
    assert {"arboleda: ra1", "arboleda: rm_sis_a", "arboleda: sis_a"} <= names
    second = arboleda("up", "--state", str(tmp_path / "second"))
    assert second.wait() == 1
    assert "another node already commands" in second.output and "/orchestrator" in second.output
    assert "Traceback" not in second.output
    assert up.interrupt() == 0, up.output


def test_a_person_drives_the_whole_cycle_by_hand(arboleda: Callable[..., Any], observer: Any) -> None:
    from std_msgs.msg import Float32MultiArray, String, UInt8

    up = arboleda("up", "--plant", str(BY_HAND))
    observer.listen(String, "/task_status", qos=latched())
    observer.listen(Float32MultiArray, "/ra1/joint_goals_q", "/rm_sis_a/path_cmd")
    observer.listen(UInt8, "/ra1/effector_cmd")
    arm = observer.publisher(UInt8, "/ra1/motion_state")
    mobile = observer.publisher(UInt8, "/rm_sis_a/motion_state")
    observer.publisher(String, "/task_request").publish(String(data="sis_a 0B 7"))

    def drive(robot: Any, topic: str, number: int) -> None:
        observer.wait(lambda: len(observer.heard[topic]) == number, f"no command {number} on {topic}")
        for state in (1, 0):
            robot.publish(UInt8(data=state))

    drive(mobile, "/rm_sis_a/path_cmd", 1)
    for number in (1, 2, 3):
        drive(arm, "/ra1/joint_goals_q", number)
    observer.wait(lambda: "done" in states(observer), "the task was not done")
    assert [message.data for message in observer.heard["/ra1/effector_cmd"]] == [1, 0]
    assert up.interrupt() == 0, up.output
