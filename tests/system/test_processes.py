"""Bridge, boards and plant in processes of their own, over real ROS 2 and a real mosquitto."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from arboleda.model.plant_model import Evidence
from arboleda.wire.status import OK, STALE

from .conftest import Chain

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy", "mosquitto")]


@pytest.mark.parametrize("evidence", list(Evidence))
@pytest.mark.smoke
def test_a_task_is_done_across_three_processes(chain: Callable[..., Chain], evidence: Evidence) -> None:
    parts = chain(evidence)
    parts.submit("sis_b 0A 4")
    change = parts.outcome("sis_b 0A 4")
    assert change["state"] == "done", change["sentence"]
    for process in (parts.plant, parts.bridge, parts.devices):
        assert process.interrupt() == 0, process.output
        assert "Traceback" not in process.output


def diagnosed(parts: Chain, name: str) -> Callable[[], tuple[int, str] | None]:
    """What `/diagnostics` says last of something: level and sentence."""
    from diagnostic_msgs.msg import DiagnosticArray

    if "/diagnostics" not in parts.observer.heard:
        parts.observer.listen(DiagnosticArray, "/diagnostics")

    def last() -> tuple[int, str] | None:
        for message in reversed(parts.observer.heard["/diagnostics"]):
            for status in message.status:
                if status.name == f"arboleda: {name}":
                    return status.level[0], status.message
        return None

    return last


def verb(parts: Chain, name: str) -> tuple[bool, str]:
    """What came of the operator's verb for the whole plant."""
    from std_srvs.srv import Trigger

    client = parts.observer.node.create_client(Trigger, f"/plant/{name}")
    parts.observer.wait(client.service_is_ready, f"there is no service /plant/{name}")
    call = client.call_async(Trigger.Request())
    parts.observer.wait(call.done, f"{name} was not answered")
    return call.result().success, call.result().message


def test_a_bridge_back_in_time_lets_the_cell_recover_and_work_on(chain: Callable[..., Chain]) -> None:
    parts = chain(Evidence.IDS, stop_timeout_s=30.0)  # the bridge starts as a process of its own
    arm, mqtt = diagnosed(parts, "ra1"), diagnosed(parts, "mqtt_bridge on MQTT")
    parts.observer.wait(lambda: arm() == (OK, "ready"), "ra1 is not ready")
    reached = (OK, f"connected to the MQTT broker at {parts.address}")
    parts.observer.wait(lambda: mqtt() == reached, "the bridge does not tell of its broker")
    parts.submit("sis_a palletizing")
    parts.wait_for_step("sis_a", "move to station 8")
    parts.bridge.kill()
    parts.observer.wait(lambda: arm() == (STALE, "ra1 is offline"), "ra1 is not stale")
    assert not parts.robot("ra1")["online"]
    parts.start("mqtt_bridge")
    change = parts.outcome("sis_a palletizing")
    assert (change["state"], change["reason"]) == ("failed", "link_lost")
    parts.wait_for_cell("sis_a", lambda cell: cell["state"] == "idle")
    assert parts.robot("ra1")["effector"] is False, "the part was not brought back"
    parts.observer.wait(lambda: arm() == (OK, "ready"), "ra1 is not ready again")
    parts.submit("sis_a 2C 0")
    assert parts.outcome("sis_a 2C 0")["state"] == "done"


def test_a_bridge_back_too_late_leaves_the_cell_held_until_it_is_retried(chain: Callable[..., Chain]) -> None:
    parts = chain(Evidence.IDS, stop_timeout_s=1.0)
    parts.submit("sis_a palletizing")
    parts.wait_for_step("sis_a", "move to station 8")
    parts.bridge.kill()
    change = parts.outcome("sis_a palletizing")
    assert (change["state"], change["reason"]) == ("failed", "link_lost")
    parts.wait_for_cell("sis_a", lambda cell: cell["state"] == "held")
    assert "ra1 was lost" in parts.cell("sis_a")["held_by"]
    parts.start("mqtt_bridge")
    parts.wait_until_ready("ra1")
    arm = parts.robot("ra1")
    assert (arm["effector"], arm["state"]) == (True, 0), "it stands still and keeps its part"
    assert parts.cell("sis_a")["state"] == "held", "only an operator lets it move"
    assert verb(parts, "retry") == (True, "")
    parts.wait_for_cell("sis_a", lambda cell: cell["state"] == "idle")
    assert parts.robot("ra1")["effector"] is False, "the part was not brought back"
