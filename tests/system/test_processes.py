"""Bridge, boards and plant in processes of their own, over real ROS 2 and a real mosquitto."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from arboleda.core.model import Evidence

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy", "mosquitto")]

SHIPPED = Path(__file__).parents[2] / "src/arboleda/arboleda/plants/plant.yaml"


@pytest.fixture
def chain(
    node: Callable[..., Any],
    mosquitto: Callable[[int], Any],
    free_port: int,
    tmp_path: Path,
    observer: Any,
) -> Callable[[Evidence], Chain]:
    def go(evidence: Evidence) -> Chain:
        mosquitto(free_port)
        return Chain(node, observer, plant_at(evidence, tmp_path), f"127.0.0.1:{free_port}", tmp_path)

    return go


def plant_at(evidence: Evidence, folder: Path) -> Path:
    """The shipped plant with slow arms, every robot at this level of evidence."""
    plant = yaml.safe_load(SHIPPED.read_text())
    for cell in plant["cells"].values():
        cell["arm"]["evidence"] = cell["mobile"]["evidence"] = evidence.value
    file = folder / "plant.yaml"
    file.write_text(yaml.safe_dump(plant))
    return file


class Chain:
    """The three nodes, and what an observer hears of them."""

    def __init__(
        self, node: Callable[..., Any], observer: Any, plant: Path, broker: str, folder: Path
    ) -> None:
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import String

        self.observer = observer
        self._node = node
        self._common = {"plant": str(plant), "broker": broker}
        latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        observer.listen(String, "/task_status", "/plant/view", qos=latched)
        self.devices = self.start("virtual_devices", rate="0.3")
        self.bridge = self.start("mqtt_bridge")
        self.plant = self.start("orchestrator", state_dir=str(folder / "state"))
        self.requests = observer.publisher(String, "/task_request")

    def start(self, name: str, **parameters: str) -> Any:
        return self._node(name, **self._common, **parameters)

    def submit(self, text: str) -> None:
        from std_msgs.msg import String

        self.requests.publish(String(data=text))

    def wait_for_step(self, cell: str, step: str) -> None:
        def at_step() -> bool:
            views = self.observer.heard["/plant/view"]
            cells = json.loads(views[-1].data)["cells"] if views else []
            return any(each["name"] == cell and each["step"] == step for each in cells)

        self.observer.wait(at_step, f"{cell} never got to {step!r}")

    def robot(self, name: str) -> dict[str, Any]:
        """What the last view says of a robot."""
        view = json.loads(self.observer.heard["/plant/view"][-1].data)
        return next(robot for robot in view["robots"] if robot["name"] == name)

    def wait_for_robot(self, name: str, ready: Callable[[dict[str, Any]], bool]) -> None:
        self.observer.wait(lambda: ready(self.robot(name)), f"{name} is not as expected")

    def outcome(self, text: str) -> dict[str, Any]:
        """The change that ended the task."""

        def ended() -> list[dict[str, Any]]:
            changes = [json.loads(message.data) for message in self.observer.heard["/task_status"]]
            return [each for each in changes if each["text"] == text and each["state"] in ("done", "failed")]

        return self.observer.wait(ended, f"{text} has no end", 45.0)[0]


LEVELS = pytest.mark.parametrize("evidence", list(Evidence))


@LEVELS
def test_a_task_is_done_across_three_processes(
    chain: Callable[[Evidence], Chain], evidence: Evidence
) -> None:
    parts = chain(evidence)
    parts.submit("sis_a 0A 4")
    assert parts.outcome("sis_a 0A 4")["state"] == "done"
    for process in (parts.plant, parts.bridge, parts.devices):
        assert process.interrupt() == 0, process.output
        assert "Traceback" not in process.output


@LEVELS
def test_a_bridge_killed_and_restarted_in_a_move_fails_it(
    chain: Callable[[Evidence], Chain], evidence: Evidence
) -> None:
    parts = chain(evidence)
    parts.submit("sis_a 0A 4")
    parts.wait_for_step("sis_a", "move to pick-up")
    before = parts.robot("rm_sis_b")["bridge_epoch"]
    parts.bridge.kill()
    parts.start("mqtt_bridge")
    change = parts.outcome("sis_a 0A 4")
    assert (change["state"], change["reason"]) == ("failed", "link_lost")
    parts.wait_for_robot("rm_sis_b", lambda robot: robot["bridge_epoch"] != before and not robot["obstacle"])
    parts.submit("sis_b 0A 4")
    change = parts.outcome("sis_b 0A 4")
    assert change["state"] == "done", change["sentence"]


@LEVELS
def test_boards_killed_and_restarted_in_a_move_fail_it(
    chain: Callable[[Evidence], Chain], evidence: Evidence
) -> None:
    parts = chain(evidence)
    parts.submit("sis_a 0A 4")
    parts.wait_for_step("sis_a", "move to pick-up")
    parts.devices.kill()
    parts.wait_for_robot("rm_sis_b", lambda robot: not robot["online"])
    parts.start("virtual_devices")
    change = parts.outcome("sis_a 0A 4")
    assert (change["state"], change["reason"]) == ("failed", "link_lost")
    parts.wait_for_robot("rm_sis_b", lambda robot: not robot["obstacle"])
    parts.submit("sis_b 0A 4")
    change = parts.outcome("sis_b 0A 4")
    assert change["state"] == "done", change["sentence"]
