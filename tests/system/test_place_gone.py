"""A plant whose files are gone while it runs ends by itself, its robots halted."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda.adapters.broker_login import address
from arboleda.adapters.mqtt import MqttClient
from arboleda.runtime import host_claim
from arboleda.wire.transport import Connection, Delivery

from ..patience import PATIENCE_S

pytestmark = pytest.mark.system
UP = ("up", "--no-ros")


def halts(plant: Any, request: pytest.FixtureRequest) -> tuple[list[str], threading.Event]:
    """Whom the plant's broker tells to halt from now on, and whether it has told anybody."""
    broker = next(found[1] for line in plant.lines if (found := re.match(r"MQTT broker: (\S+)", line)))
    joined, halted, robots = threading.Event(), threading.Event(), list[str]()

    def hear(event: Any) -> None:
        if isinstance(event, Connection):
            joined.set()
        elif isinstance(event, Delivery) and json.loads(event.payload).get("paro"):
            robots.append(event.topic.partition("/")[0])
            halted.set()

    observer = MqttClient("observer", address(broker), subscriptions=["+/paro"], on_event=hear)
    observer.start()
    request.addfinalizer(observer.close)
    assert joined.wait(PATIENCE_S), "the observer did not reach the broker"
    return robots, halted


def test_a_plant_whose_files_are_gone_halts_its_robots_and_ends_with_a_sentence(
    arboleda: Callable[..., Any], request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    plant = arboleda(*UP, "sis_a 0B 4")
    plant.wait_for("sis_a: drive path 0B")
    robots, halted = halts(plant, request)
    shutil.rmtree(tmp_path / "state")
    (tmp_path / "state").mkdir()  # a folder of that name is there again, and it is not the plant's
    assert halted.wait(PATIENCE_S), plant.output
    assert plant.wait() == 1
    assert robots[0] == "rm_sis_a"
    gone = r"arboleda: The .*plant\.(sqlite|sqlite-wal|lock) was deleted or moved away"
    assert re.match(gone, plant.lines[-1]), plant.output
    assert "start again" in plant.lines[-1] and "Traceback" not in plant.output


@pytest.mark.skipif(not host_claim.HAS_ABSTRACT, reason="only Linux has names without files")
def test_no_second_plant_starts_beside_one_whose_directory_was_deleted(
    arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    """The first is stopped, so that it cannot end before the second has looked."""
    first = arboleda(*UP)
    first.wait_for("HTTP API")
    os.kill(first.pid, signal.SIGSTOP)
    shutil.rmtree(tmp_path / "state")
    second = arboleda(*UP)
    assert second.wait() == 1
    assert f"still runs (process {first.pid}), though its files there are gone" in second.output
    os.kill(first.pid, signal.SIGCONT)
    assert first.wait() == 1 and "while the plant ran" in first.lines[-1]
    third = arboleda(*UP)
    third.wait_for("HTTP API")


def flip(log: Path) -> None:
    content = bytearray(log.read_bytes())
    content[len(content) // 2] ^= 1
    log.write_bytes(content)


@pytest.mark.parametrize(
    "lose",
    [flip, lambda log: os.truncate(log, log.stat().st_size // 2), Path.unlink],
    ids=["one bit", "half", "removed"],
)
def test_a_killed_plant_whose_log_has_lost_a_stop_does_not_start_as_if_nothing_was_stopped(
    lose: Callable[[Path], object], arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    first = arboleda(*UP)
    first.wait_for("HTTP API")
    assert arboleda("stop", "sis_a").wait() == 0
    first.kill()
    lose(tmp_path / "state" / "plant.sqlite-wal")
    second = arboleda(*UP)
    assert second.wait() == 1
    assert "is older than what the plant has told" in second.lines[-1], second.output
