"""The virtual arm of Universal Robots as a client that we did not write sees it: ur_rtde.

Its ports cannot be chosen, so that each test has an address of its own.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from tests.patience import PATIENCE_S

from ..played import Played, play

rtde_receive = pytest.importorskip("rtde_receive", reason="ur-rtde is not there")
dashboard_client = pytest.importorskip("dashboard_client", reason="ur-rtde is not there")
pytestmark = pytest.mark.system

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


def host_of(request: pytest.FixtureRequest) -> str:
    return f"127.0.29.{1 + sum(request.node.name.encode()) % 250}"


@pytest.fixture
def controller(request: pytest.FixtureRequest, start: Callable[..., Any]) -> Played:
    """A virtual arm; a process of its own, as ur_rtde keeps the GIL."""
    return play(start, "ur", "--host", host_of(request))


@pytest.fixture
def dashboard(request: pytest.FixtureRequest, controller: Played) -> Iterator[Any]:
    client = dashboard_client.DashboardClient(host_of(request))
    client.connect()
    yield client
    client.disconnect()


@pytest.fixture
def receive(request: pytest.FixtureRequest, controller: Played) -> Iterator[Any]:
    client = rtde_receive.RTDEReceiveInterface(host_of(request), 125.0, VARIABLES)
    yield client
    client.disconnect()


def test_a_foreign_client_reads_power_speed_and_a_protective_stop_and_unlocks_it(
    controller: Played, dashboard: Any, receive: Any
) -> None:
    assert dashboard.robotmode() == "Robotmode: POWER_OFF"
    dashboard.powerOn()
    until(lambda: receive.getRobotMode() == 5)
    dashboard.brakeRelease()
    until(lambda: receive.getRobotMode() == 7)
    assert dashboard.safetystatus() == "Safetystatus: NORMAL"
    assert dashboard.isInRemoteControl() is True
    assert receive.getActualQ() == [0.0] * 6
    controller.switch("slider", on=True)
    until(lambda: receive.getTargetSpeedFraction() == pytest.approx(0.03))
    assert receive.getSpeedScaling() == pytest.approx(0.03)
    controller.switch("safeguard", on=True)
    until(lambda: receive.getSafetyMode() == 5)
    controller.switch("safeguard", on=False)
    until(lambda: receive.getSafetyMode() == 1)
    assert not receive.isProtectiveStopped()
    dashboard.closeSafetyPopup()
    dashboard.unlockProtectiveStop()
