"""The command `arboleda` as a person uses it."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from .conftest import paths

pytestmark = pytest.mark.system

DEMO = ("sis_a 0B 7", "sis_b 1C 3", "sis_c 2A 5")


@pytest.mark.requires("rclpy")
@pytest.mark.smoke
def test_run_does_three_tasks_over_ros_2_and_mqtt(arboleda: Callable[..., Any], ros_domain: int) -> None:
    run = arboleda("up", "--once", *DEMO, "--rate", "5")
    assert run.wait() == 0, run.output
    for task in DEMO:
        assert f"done      {task}" in run.output
    first_end = next(n for n, line in enumerate(run.lines) if " done      " in line)
    assert sum(" running   " in line for line in run.lines[:first_end]) == 3
    assert "ra1: still, effector off" in run.output


@pytest.mark.smoke
def test_run_works_on_a_real_mosquitto(
    arboleda: Callable[..., Any], mosquitto: Callable[[int], Any], free_port: int
) -> None:
    mosquitto(free_port)
    run = arboleda("up", "--once", *DEMO, "--rate", "10", "--no-ros", "--broker", f"127.0.0.1:{free_port}")
    assert run.wait() == 0, run.output


@pytest.mark.smoke
def test_a_running_plant_takes_tasks_tells_its_state_and_ends_cleanly_on_ctrl_c(
    arboleda: Callable[..., Any],
) -> None:
    up = arboleda("up", "--no-ros", "--rate", "10")
    up.wait_for("HTTP API")
    submit = arboleda("submit", "SIS_B", "1c", "3")
    assert submit.wait() == 0 and "sis_b 1C 3" in submit.output
    refused = arboleda("submit", "sis_b 1D 3")
    assert refused.wait() == 2 and "'1D' is not a path of sis_b" in refused.output
    up.wait_for("done      sis_b 1C 3")
    status = arboleda("status")
    assert status.wait() == 0 and "sis_b" in status.output
    second = arboleda("up", "--no-ros")
    assert second.wait() == 1 and "already running" in second.output
    up.wait_for("refused")
    assert up.interrupt() == 0, up.output
    assert "ra2: still, effector off" in up.output
    assert "Traceback" not in up.output


def test_who_submits_may_wait_for_the_end_of_the_task_and_watch_the_plant(
    arboleda: Callable[..., Any], typed: Callable[..., tuple[int, str]]
) -> None:
    up = arboleda("up", "--no-ros", "--rate", "3")
    up.wait_for("HTTP API")
    watch = arboleda("status", "--watch", "--json")
    watch.wait_for('"kind": "snapshot"')
    done = arboleda("submit", "--wait", "sis_a 0B 7 #one")
    assert done.wait() == 0
    assert [line.split()[0] for line in done.output.splitlines()] == ["queued:", "running:", "done:"]
    watch.wait_for('"state": "done"')
    stopped = arboleda("submit", "--wait", "sis_b 0B 7")
    stopped.wait_for("running: sis_b 0B 7")
    assert typed("stop", "sis_b")[0] == 0
    assert stopped.wait() == 1 and "sis_b was stopped by the operator" in stopped.output
    left = arboleda("submit", "--wait", "sis_c 0B 7 #two")
    left.wait_for("running: sis_c 0B 7")
    assert up.interrupt() == 0
    assert left.wait() == 1
    assert "the plant has ended, and #two has not: its next start has it again" in left.output
    assert watch.wait() == 0 and "Traceback" not in watch.output + left.output


def test_the_broker_may_come_late_and_go_and_come_back(
    arboleda: Callable[..., Any], mosquitto: Callable[[int], Any], free_port: int
) -> None:
    up = arboleda("up", "sis_a 0B 7", "--no-ros", "--broker", f"127.0.0.1:{free_port}")
    up.wait_for(f"The MQTT broker at 127.0.0.1:{free_port} is not there")
    broker = mosquitto(free_port)
    up.wait_for("sis_a: move to pick-up")
    broker.kill()
    up.wait_for("failed    sis_a 0B 7")
    mosquitto(free_port)
    up.wait_for("is there.", times=3)
    submit = arboleda("submit", "sis_b 1C 3")
    assert submit.wait() == 0
    up.wait_for("done      sis_b 1C 3")
    assert up.interrupt() == 0
    assert "Traceback" not in up.output


def test_virtual_boards_do_not_fight_boards_that_are_there(
    arboleda: Callable[..., Any], mosquitto: Callable[[int], Any], free_port: int, tmp_path: Path
) -> None:
    mosquitto(free_port)
    broker = ("--no-ros", "--broker", f"127.0.0.1:{free_port}")
    first = arboleda("up", *broker, "--rate", "10")
    first.wait_for("HTTP API")
    second = arboleda("up", "--once", "sis_a 0B 7", *broker, "--state", str(tmp_path / "second"))
    assert second.wait() == 1
    assert "already live on this broker" in second.output and "--boards real" in second.output
    assert arboleda("submit", "sis_a 0B 7").wait() == 0
    first.wait_for("done      sis_a 0B 7")


def test_a_reader_that_goes_away_does_not_stop_the_plant(start: Callable[..., Any], tmp_path: Path) -> None:
    command = f"{sys.executable} -c 'from arboleda.cli.main import main; main()'"
    task = f"run 'sis_a 0B 7' --no-ros --rate 10 --state {tmp_path}/state"
    shell = start("bash", "-c", f"{command} {task} | head -1", env={"PYTHONPATH": paths()})
    assert shell.wait() == 0
    assert "Traceback" not in shell.output
