"""The real chain cut in the middle of a move: everything ends in a safe, named state."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda.adapters.broker_login import address
from arboleda.adapters.mqtt import MqttClient
from arboleda.model.plant_model import Evidence
from arboleda.wire.transport import Connection, Delivery

from ..patience import PATIENCE_S
from .conftest import Chain, plant_at

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy", "mosquitto")]
PICK_UP = 0.7854  # rad, of ra1's first joint


@pytest.fixture
def moving(chain: Callable[..., Chain]) -> Chain:
    """A chain whose arm ra1 is on its way to the pick-up pose."""
    parts = chain(Evidence.IDS)
    parts.submit("sis_a 0B 4")
    parts.wait_for_step("sis_a", "move to pick-up")
    return parts


def rests_short_of_the_goal(parts: Chain) -> float:
    """Where ra1's first joint came to rest, by its own reports."""
    seen = parts.observer.heard["/r1/joint_states"]

    def resting() -> bool:
        last = [message.position[0] for message in seen[-5:]]
        return len(last) == 5 and len(set(last)) == 1 and last[0] > 0.0

    del seen[:]
    parts.observer.wait(resting, "ra1 did not come to rest")
    return seen[-1].position[0]


def test_a_plant_killed_in_a_move_leaves_the_boards_to_stop_by_themselves(moving: Chain) -> None:
    moving.plant.kill()
    assert 0.0 < rests_short_of_the_goal(moving) < PICK_UP - 0.05
    del moving.observer.heard["/plant/view"][:]
    moving.start("orchestrator", state_dir=moving.state)
    moving.wait_for_cell("sis_a", lambda cell: cell["state"] == "held" and not cell["refused"].get("resume"))
    assert moving.cell("sis_a")["held_by"].endswith(
        'at its step "move to pick-up"); resume sis_a or abandon sis_a'
    )


def test_the_boards_of_one_cell_killed_in_a_move_fail_its_task_and_no_other(
    chain: Callable[..., Chain], tmp_path: Path
) -> None:
    parts = chain(Evidence.IDS, stop_timeout_s=1.0)
    parts.devices.kill()
    parts.wait_for_robot("ra1", lambda robot: not robot["online"])
    cells = (("sis_a",), ("sis_b", "sis_c"))
    plants = [str(plant_at(Evidence.IDS, tmp_path, *names)) for names in cells]
    boards = [parts.start("virtual_devices", plant=plant) for plant in plants]
    for text in ("sis_a 0B 4", "sis_b 0A 4"):
        parts.submit(text)
    parts.wait_for_step("sis_a", "move to pick-up")
    boards[0].kill()
    change = parts.outcome("sis_a 0B 4")
    assert (change["state"], change["reason"]) == ("failed", "link_lost")
    assert change["sentence"].startswith("ra1: ")
    assert parts.outcome("sis_b 0A 4")["state"] == "done"
    parts.wait_for_cell("sis_a", lambda cell: cell["state"] == "held")


def test_a_broker_that_goes_in_a_move_fails_the_task_and_the_cell_recovers_when_it_is_back(
    moving: Chain, mosquitto: Callable[[int], Any]
) -> None:
    moving.broker.kill()
    mosquitto(address(moving.address).port)
    change = moving.outcome("sis_a 0B 4")
    assert (change["state"], change["reason"]) == ("failed", "link_lost")
    moving.submit("sis_b 0A 4")
    assert moving.outcome("sis_b 0A 4")["state"] == "done"


def test_a_stop_in_a_move_reaches_the_board_and_holds_until_clear_and_reset(
    moving: Chain, request: pytest.FixtureRequest
) -> None:
    from std_srvs.srv import Trigger

    joined, heard = threading.Event(), threading.Event()
    times: dict[str, float] = {}

    def on_event(event: Any) -> None:
        if isinstance(event, Connection):
            joined.set()
        if isinstance(event, Delivery) and b'"paro":1' in event.payload.replace(b" ", b""):
            times.setdefault(event.topic, time.monotonic())
            heard.set()

    board = MqttClient("observer", address(moving.address), subscriptions=["ra_1/paro"], on_event=on_event)
    board.start()
    request.addfinalizer(board.close)
    assert joined.wait(PATIENCE_S), "the observer did not reach the broker"
    stop = moving.observer.node.create_client(Trigger, "/plant/stop")
    moving.observer.wait(stop.service_is_ready, "no service /plant/stop")
    asked = time.monotonic()
    answer = stop.call_async(Trigger.Request())
    moving.observer.wait(answer.done, "the stop was not answered")
    assert answer.result().success
    assert heard.wait(PATIENCE_S), "no stop on MQTT"
    print(f"stop: {1000 * (times['ra_1/paro'] - asked):.1f} ms from the request to the board's command")
    change = moving.outcome("sis_a 0B 4")
    assert (change["state"], change["reason"]) == ("failed", "stopped")
    assert rests_short_of_the_goal(moving) < PICK_UP - 0.05
    moving.wait_for_cell("sis_a", lambda cell: cell["state"] == "aborted")
    moving.submit("sis_a 0B 4 #again")
    moving.wait_for_cell("sis_a", lambda cell: cell["queue"] == ["again"])
    assert moving.cell("sis_a")["state"] == "aborted"
    assert rests_short_of_the_goal(moving) < PICK_UP - 0.05
