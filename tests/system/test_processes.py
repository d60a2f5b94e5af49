"""Bridge, boards and plant in processes of their own, over real ROS 2 and a real mosquitto."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from arboleda.core.model import Evidence

from .conftest import Chain

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy", "mosquitto")]

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
    if evidence is Evidence.JOINTS:  # a board that was away may have rebooted, and cannot say where it is
        parts.wait_for_robot("rm_sis_b", lambda robot: robot["obstacle"] == "rm_sis_b is not homed")
        return
    parts.wait_for_robot("rm_sis_b", lambda robot: not robot["obstacle"])
    parts.submit("sis_b 0A 4")
    change = parts.outcome("sis_b 0A 4")
    assert change["state"] == "done", change["sentence"]
