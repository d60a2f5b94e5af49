"""The bridge alone, for people with an orchestrator of their own: plain topics are its whole interface."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy", "mosquitto")]

JOINTS = ["r1_brazo_joint", "r1_antebrazo_joint", "r1_efector_joint"]


class Foreigner:
    """Publishes goals without labels or heartbeat and waits for what the robots report."""

    def __init__(self, observer: Any) -> None:
        from sensor_msgs.msg import JointState
        from std_msgs.msg import Float32MultiArray, UInt8

        self._observer = observer
        observer.listen(UInt8, "/ra1/motion_state", "/rm_sis_a/motion_state")
        observer.listen(JointState, "/r1/joint_states", "/rm_sis_a/joint_states")
        arrays = ("/ra1/joint_goals_q", "/rm_sis_a/path_cmd")
        words = ("/ra1/effector_cmd", "/ra1/stop_cmd", "/ra1/home_cmd")
        self._publishers = {topic: observer.publisher(Float32MultiArray, topic) for topic in arrays}
        self._publishers |= {topic: observer.publisher(UInt8, topic) for topic in words}

    def say(self, topic: str, data: Any) -> None:
        publisher = self._publishers[topic]
        publisher.publish(publisher.msg_type(data=data))

    def drive(self, robot: str, goal: list[float]) -> None:
        """Tell an arm a goal, and wait until it has said that it moves; it may be there by then."""
        before = len(self.states(robot))
        self.say(f"/{robot}/joint_goals_q", goal)
        self._observer.wait(lambda: 1 in self.states(robot)[before:], f"{robot} never moved")

    def states(self, robot: str) -> list[int]:
        return [message.data for message in self._observer.heard[f"/{robot}/motion_state"]]

    def place(self, twin: str) -> list[float]:
        """The measured joints now."""
        return list(self._observer.heard[f"/{twin}/joint_states"][-1].position)

    def still(self, twin: str) -> list[float]:
        """The measured joints, once two later reports agree."""
        heard = self._observer.heard[f"/{twin}/joint_states"]
        seen = len(heard)

        def agree() -> bool:
            return len(heard) > seen + 1 and heard[-1].position == heard[-2].position

        self._observer.wait(agree, f"{twin} does not come to rest")
        return self.place(twin)

    def wait_for_state(self, robot: str, state: int) -> None:
        self._observer.wait(
            lambda: self.states(robot)[-1:] == [state], f"{robot} never said {state}: {self.states(robot)}"
        )

    def wait_for_place(self, twin: str, *wanted: float) -> None:
        def there() -> bool:
            return bool(self._observer.heard[f"/{twin}/joint_states"]) and self.place(twin) == pytest.approx(
                list(wanted), abs=0.02
            )

        self._observer.wait(there, f"{twin} never came to {wanted}")


@pytest.fixture
def broker(mosquitto: Callable[[int], Any], free_port: int) -> Any:
    return mosquitto(free_port)


@pytest.fixture
def bridge(node: Callable[..., Any], broker: Any, free_port: int) -> Any:
    node("virtual_devices", broker=f"127.0.0.1:{free_port}", rate="3")
    return node("mqtt_bridge", broker=f"127.0.0.1:{free_port}")


@pytest.fixture
def foreigner(bridge: Any, observer: Any) -> Foreigner:
    made = Foreigner(observer)
    made.wait_for_state("ra1", 0)
    made.wait_for_state("rm_sis_a", 0)
    return made


def stopped_on_its_way(foreigner: Foreigner) -> list[float]:
    """Joints of the arm, stopped in a move; on a busy machine a move may have ended before the stop came."""
    for goal in ([2.0, 2.0, 0.05], [-2.0, -2.0, 0.05]) * 3:
        foreigner.drive("ra1", goal)
        foreigner.say("/ra1/stop_cmd", 1)
        foreigner.wait_for_state("ra1", 4)
        stopped = foreigner.still("r1")
        if abs(stopped[0] - goal[0]) > 0.1:
            return stopped
        foreigner.say("/ra1/stop_cmd", 0)
        foreigner.wait_for_state("ra1", 0)
    pytest.fail("the stop came after the end of each move")


def test_plain_goals_drive_a_stop_latches_and_a_bridge_that_ends_halts_what_moves(
    foreigner: Foreigner, observer: Any, bridge: Any, broker: Any
) -> None:
    foreigner.say("/rm_sis_a/path_cmd", [0.0, 3.0, 4.0])
    foreigner.wait_for_place("rm_sis_a", 0.1, 0.1)
    foreigner.say("/ra1/joint_goals_q", [0.5, -0.25, 0.05])
    foreigner.wait_for_place("r1", 0.5, -0.25, 0.05)
    foreigner.wait_for_state("ra1", 0)
    assert 1 in foreigner.states("ra1") and 1 in foreigner.states("rm_sis_a")
    assert observer.heard["/r1/joint_states"][-1].name == JOINTS

    stopped = stopped_on_its_way(foreigner)
    foreigner.say("/ra1/joint_goals_q", [0.0, 0.0, 0.0])
    foreigner.say("/ra1/stop_cmd", 0)
    foreigner.wait_for_state("ra1", 0)
    assert foreigner.still("r1") == stopped, "a goal was obeyed under the latch"
    foreigner.say("/ra1/home_cmd", 1)
    foreigner.wait_for_place("r1", 0.0, 0.0, 0.0)
    foreigner.wait_for_state("ra1", 0)

    foreigner.drive("ra1", [2.0, 2.0, 0.05])
    bridge.interrupt()
    broker.wait_for("'ra_1/paro'")


def test_what_is_refused_is_told_with_its_reason(foreigner: Foreigner, observer: Any, bridge: Any) -> None:
    told = rejections(observer, "ra1", "rm_sis_a")

    def refused(robot: str, topic: str, data: list[float]) -> dict[str, Any]:
        """Its refusal; said again until the bridge knows who listens, as ROS 2 drops what nobody hears."""

        def is_told() -> bool:
            foreigner.say(f"/{robot}/{topic}", data)
            return bool(told(robot))

        observer.wait(is_told, f"no refusal of {topic} was told")
        return told(robot)[0]

    goal, path = refused("ra1", "joint_goals_q", [9.0, 0.0, 0.0]), refused("rm_sis_a", "path_cmd", [7.0, 8.0])
    assert (goal["command"], goal["id"], goal["reason"]) == ("joint_goals_q", "", "limite")
    assert (path["command"], path["reason"]) == ("path_cmd", "limite")

    def is_told_again() -> bool:
        foreigner.say("/ra1/joint_goals_q", [9.0, 0.0, 0.0])
        return len(told("ra1")) > 1

    observer.wait(is_told_again, "the refusal of what was said again was not told")
    counts = [each["count"] for each in told("ra1")]
    assert counts == sorted(set(counts)), "ROS 2 may lose a message, and a refusal is counted once"
    bridge.wait_for("a path begins at the robot's node or next to it")
    bridge.wait_for("number 1 is 9; allowed: -2.618 to 2.618 rad")


def test_a_robot_of_a_live_plant_takes_no_goal_but_a_stop(
    observer: Any, bridge: Any, node: Callable[..., Any], free_port: int, tmp_path: Path
) -> None:
    from std_msgs.msg import String

    told = rejections(observer, "ra1")
    observer.listen(String, "/plant/view")
    node("orchestrator", broker=f"127.0.0.1:{free_port}", state_dir=str(tmp_path / "state"))
    observer.wait(lambda: observer.heard["/plant/view"], "the plant does not start")
    foreigner = Foreigner(observer)
    foreigner.wait_for_state("ra1", 0)

    def is_refused_by_name() -> bool:
        """Say it until the bridge has found out who says it, which ROS 2 tells when it likes."""
        foreigner.say("/ra1/joint_goals_q", [0.5, 0.2, 0.03])
        return any("joint_goals_q of /observer was refused (foreign)" in line for line in bridge.lines)

    observer.wait(is_refused_by_name, "the goal was not refused")
    assert {each["reason"] for each in told("ra1")} == {"foreign"}
    foreigner.say("/ra1/stop_cmd", 1)
    foreigner.wait_for_state("ra1", 4)
    bridge.wait_for("ra1: stop_cmd 1 of /observer was obeyed")

    def seen() -> list[str]:
        view = json.loads(observer.heard["/plant/view"][-1].data)
        return [each["sentence"] for each in view["interference"]]

    observer.wait(
        lambda: any("stop_cmd 1 of /observer" in each for each in seen()), "nobody tells of the stop"
    )
    assert any("joint_goals_q of /observer" in each for each in seen())
    assert 1 not in foreigner.states("ra1"), "the arm moved"
    assert foreigner.still("r1") == pytest.approx([0.0, 0.0, 0.0])


def rejections(observer: Any, *robots: str) -> Callable[[str], list[dict[str, Any]]]:
    """What `/{robot}/rejected` has told since."""
    from std_msgs.msg import String

    for robot in robots:
        topic = f"/{robot}/rejected"
        observer.listen(String, topic)
        observer.wait(lambda topic=topic: observer.node.count_publishers(topic), f"nobody publishes {topic}")
    return lambda robot: [json.loads(message.data) for message in observer.heard[f"/{robot}/rejected"]]
