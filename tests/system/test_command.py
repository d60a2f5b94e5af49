"""The command `arboleda` as a person uses it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda.plant_file.loader import load
from arboleda.runtime.build import Options, build

from ..patience import PATIENCE_S
from .conftest import paths

pytestmark = pytest.mark.system

DEMO = ("sis_a 0B 7", "sis_b 1C 3", "sis_c 2A 5")


@pytest.mark.requires("rclpy")
@pytest.mark.smoke
def test_run_does_three_tasks_over_ros_2_and_mqtt(arboleda: Callable[..., Any], ros_domain: int) -> None:
    run = arboleda("run", *DEMO, "--rate", "5")
    assert run.wait() == 0, run.output
    for task in DEMO:
        assert f"done      {task}" in run.output
    first_end = next(n for n, line in enumerate(run.lines) if " done      " in line)
    assert sum(" running   " in line for line in run.lines[:first_end]) == 3
    assert "ra1: still, effector off" in run.output


def test_run_without_ros_does_the_same(arboleda: Callable[..., Any]) -> None:
    run = arboleda("run", *DEMO, "sis_a 2C 0", "ra1 palletizing", "--rate", "10", "--no-ros")
    assert run.wait() == 0, run.output
    timed = re.compile(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d done      ")
    assert sum(timed.match(line) is not None for line in run.lines) == 5


@pytest.mark.smoke
def test_run_works_on_a_real_mosquitto(
    arboleda: Callable[..., Any], mosquitto: Callable[[int], Any], free_port: int
) -> None:
    mosquitto(free_port)
    run = arboleda("run", *DEMO, "--rate", "10", "--no-ros", "--broker", f"127.0.0.1:{free_port}")
    assert run.wait() == 0, run.output


@pytest.mark.parametrize(
    ("args", "sentence"),
    [
        (("sis_z 0B 7", "sis_a 0B 9"), "'sis_z' is not a cell"),
        (("sis_a 0B 9",), "'9' is not a station"),
        (("sis_a 0B 7", "--plant", "nowhere.yaml"), "nowhere.yaml: there is no such file"),
        (("sis_a 0B 7", "--rate", "0"), "0 is not a rate; allowed: 0.1 to 100"),
        (("sis_a 0B 7", "--broker", "host:port"), "is not a broker address"),
        ((), "Missing argument"),
    ],
    ids=["cell", "station", "plant", "rate", "broker", "no task"],
)
def test_bad_input_ends_with_2_before_anything_starts(
    typed: Callable[..., tuple[int, str]], args: tuple[str, ...], sentence: str
) -> None:
    status, said = typed("run", *args)
    assert status == 2
    assert sentence in said
    assert "Traceback" not in said and "broker:" not in said


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


def test_who_waits_for_a_task_may_stop_waiting(arboleda: Callable[..., Any]) -> None:
    up = arboleda("up", "--no-ros", "--rate", "3")
    up.wait_for("HTTP API")
    waits = arboleda("submit", "--wait", "sis_a 0B 7")
    waits.wait_for("running: sis_a 0B 7")
    assert waits.interrupt() == 130 and "Traceback" not in waits.output
    up.wait_for("done      sis_a 0B 7")
    assert up.interrupt() == 0


@pytest.mark.parametrize(
    ("shell", "typed_so_far"),
    [
        ("bash", {"COMP_WORDS": "arboleda sub", "COMP_CWORD": "1"}),
        ("zsh", {"_TYPER_COMPLETE_ARGS": "arboleda sub"}),
        ("fish", {"_TYPER_COMPLETE_ARGS": "arboleda sub", "_TYPER_COMPLETE_FISH_ACTION": "get-args"}),
    ],
)
def test_shells_complete_the_command(
    start: Callable[..., Any], shell: str, typed_so_far: dict[str, str]
) -> None:
    main = "from arboleda.cli.main import main; main()"
    asks = {"_ARBOLEDA_COMPLETE": f"complete_{shell}", "PYTHONPATH": paths(), **typed_so_far}
    completed = start(sys.executable, "-c", main, env=asks)
    assert completed.wait() == 0 and "submit" in completed.output


def test_ctrl_c_in_the_middle_of_a_move_halts_it(arboleda: Callable[..., Any]) -> None:
    up = arboleda("up", "sis_a 0B 7", "--no-ros")
    up.wait_for("sis_a: move to pick-up")
    assert up.interrupt() == 0
    assert "ra1: still" in up.output
    assert "sis_a: sis_a 0B 7 is left for the next start" in up.output


def test_tasks_and_operators_are_lines_with_time_in_the_log_file(
    arboleda: Callable[..., Any], typed: Callable[..., tuple[int, str]], tmp_path: Path
) -> None:
    up = arboleda("up", "sis_a 0B 7", "--no-ros", "--rate", "10")
    up.wait_for("done      sis_a 0B 7")
    assert typed("hold", "sis_a")[0] != 0
    assert typed("stop", "sis_b")[0] == 0
    up.wait_for("stop sis_b")
    assert up.interrupt() == 0
    lines = (tmp_path / "state" / "arboleda.log").read_text().splitlines()
    told = [re.sub(r"^\d{4}-\d\d-\d\d \d\d:\d\d:\d\d,\d{3} ", "", line) for line in lines]
    tasks = [line for line in told if " arboleda.tasks: " in line]
    for line, state in zip(tasks, ("queued   ", "running  ", "done     "), strict=True):
        assert line.startswith(f"INFO arboleda.tasks: {state} sis_a 0B 7")
    refused, stopped = (line for line in told if " arboleda.operators: " in line)
    assert refused.startswith("INFO arboleda.operators: hold sis_a was refused: ")
    assert stopped == "INFO arboleda.operators: stop sis_b"


BY_HAND = str(Path(__file__).parents[2] / "examples/plants/by_hand.yaml")


@pytest.mark.requires("rclpy")
def test_a_plant_without_boards_has_no_broker(arboleda: Callable[..., Any], ros_domain: int) -> None:
    up = arboleda("up", "--plant", BY_HAND)
    up.wait_for("http://127.0.0.1:")
    assert len(listening(up.pid)) == 1, "page and API alone"
    assert "MQTT" not in up.output
    assert up.interrupt() == 0


def test_a_plant_without_boards_needs_ros_2(arboleda: Callable[..., Any]) -> None:
    run = arboleda("up", "--plant", BY_HAND, "--no-ros")
    assert run.wait() == 1
    assert "ra1, rm_sis_a: link ros needs ROS 2" in run.output


def listening(process: int) -> set[str]:
    """The TCP sockets of a process on which it waits for connections."""
    held = {os.readlink(file) for file in Path(f"/proc/{process}/fd").iterdir() if file.is_symlink()}
    tables = [Path(f"/proc/net/{name}").read_text().splitlines()[1:] for name in ("tcp", "tcp6")]
    rows = [line.split() for table in tables for line in table]
    waits = "0A"
    return {row[9] for row in rows if row[3] == waits and f"socket:[{row[9]}]" in held}


def test_submit_and_status_without_a_plant_say_so(arboleda: Callable[..., Any]) -> None:
    for verb in (("submit", "sis_a 0B 7"), ("status",)):
        asked = arboleda(*verb)
        assert asked.wait() == 1
        assert "No plant is running" in asked.output


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
    second = arboleda("run", "sis_a 0B 7", *broker, "--state", str(tmp_path / "second"))
    assert second.wait() == 1
    assert "already live on this broker" in second.output and "--boards real" in second.output
    assert arboleda("submit", "sis_a 0B 7").wait() == 0
    first.wait_for("done      sis_a 0B 7")


def test_real_boards_are_driven_where_no_virtual_ones_are_wanted(
    arboleda: Callable[..., Any],
    mosquitto: Callable[[int], Any],
    free_port: int,
    tmp_path: Path,
    request: pytest.FixtureRequest,
) -> None:
    mosquitto(free_port)
    address = f"127.0.0.1:{free_port}"
    boards = build(load(None), ["devices"], Options(broker=address, rate=10.0, state_dir=tmp_path / "boards"))
    boards.start()
    request.addfinalizer(boards.stop)
    state = ("--state", str(tmp_path / "second"))
    run = arboleda("run", "sis_b 0B 7", "--no-ros", "--broker", address, *state, "--boards", "real")
    assert run.wait() == 0, run.output


def test_a_reader_that_goes_away_does_not_stop_the_plant(start: Callable[..., Any], tmp_path: Path) -> None:
    command = f"{sys.executable} -c 'from arboleda.cli.main import main; main()'"
    task = f"run 'sis_a 0B 7' --no-ros --rate 10 --state {tmp_path}/state"
    shell = start("bash", "-c", f"{command} {task} | head -1", env={"PYTHONPATH": paths()})
    assert shell.wait() == 0
    assert "Traceback" not in shell.output


def test_a_png_is_not_poured_into_a_terminal() -> None:
    screen, terminal = os.openpty()
    main = "from arboleda.cli.main import main; main()"
    command = [sys.executable, "-c", main, "tree", "storage", "--format", "png"]
    environ = {**os.environ, "PYTHONPATH": paths()}
    ran = subprocess.run(
        command,
        stdout=terminal,
        stderr=subprocess.PIPE,
        env=environ,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    os.close(terminal)
    os.close(screen)
    assert ran.returncode == 2 and "add > storage.png" in ran.stderr
