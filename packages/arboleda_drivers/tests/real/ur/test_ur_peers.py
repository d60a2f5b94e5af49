"""The virtual arm of Universal Robots as a client that we did not write sees it: ur_rtde.

Its ports cannot be chosen, so that each test has an address of its own.
"""

from __future__ import annotations

import re
import sys
import time
import urllib.request
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from tests.patience import PATIENCE_S

rtde_receive = pytest.importorskip("rtde_receive", reason="ur-rtde is not there")
dashboard_client = pytest.importorskip("dashboard_client", reason="ur-rtde is not there")
pytestmark = pytest.mark.system

COMMAND = "from arboleda.cli.main import main; main()"
VARIABLES = [
    "timestamp",
    "actual_q",
    "robot_mode",
    "safety_mode",
    "runtime_state",
    "robot_status_bits",
    "safety_status_bits",
    "actual_digital_output_bits",
    "speed_scaling",
    "target_speed_fraction",
]


def until(is_so: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE_S
    while not is_so():
        assert time.monotonic() < end
        time.sleep(0.02)


@pytest.fixture
def controller(request: pytest.FixtureRequest, start: Callable[..., Any]) -> tuple[str, str]:
    """Address of a virtual arm, and where its faults are; a process of its own, as ur_rtde keeps the GIL."""
    host = f"127.0.29.{1 + sum(request.node.name.encode()) % 250}"
    process = start(sys.executable, "-c", COMMAND, "virtual", "ur", "--host", host, "--fault-port", "0")
    process.wait_for("faults are switched on ")
    faults = re.search(r"switched on (\S+)", process.output)
    assert faults
    return host, faults[1]


def switch(faults: str, name: str, method: str) -> None:
    request = urllib.request.Request(f"{faults}/{name}", method=method)
    urllib.request.urlopen(request, timeout=PATIENCE_S).close()


@pytest.fixture
def dashboard(controller: tuple[str, str]) -> Iterator[Any]:
    client = dashboard_client.DashboardClient(controller[0])
    client.connect()
    yield client
    client.disconnect()


@pytest.fixture
def receive(controller: tuple[str, str]) -> Iterator[Any]:
    client = rtde_receive.RTDEReceiveInterface(controller[0], 125.0, VARIABLES)
    yield client
    client.disconnect()


def test_a_foreign_client_reads_power_speed_and_a_protective_stop_and_unlocks_it(
    controller: tuple[str, str], dashboard: Any, receive: Any
) -> None:
    assert dashboard.robotmode() == "Robotmode: POWER_OFF"
    dashboard.powerOn()
    until(lambda: receive.getRobotMode() == 5)
    dashboard.brakeRelease()
    until(lambda: receive.getRobotMode() == 7)
    assert dashboard.safetystatus() == "Safetystatus: NORMAL"
    assert dashboard.isInRemoteControl() is True
    assert receive.getActualQ() == [0.0] * 6
    switch(controller[1], "slider", "PUT")
    until(lambda: receive.getTargetSpeedFraction() == pytest.approx(0.03))
    assert receive.getSpeedScaling() == pytest.approx(0.03)
    switch(controller[1], "safeguard", "PUT")
    until(lambda: receive.getSafetyMode() == 5)
    switch(controller[1], "safeguard", "DELETE")
    until(lambda: receive.getSafetyMode() == 1)
    assert not receive.isProtectiveStopped()
    dashboard.closeSafetyPopup()
    dashboard.unlockProtectiveStop()
