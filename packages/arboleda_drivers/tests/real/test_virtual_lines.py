"""The examples at a serial line against the virtual devices, as they are typed."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.packages import ROOT

from .played import play, typed

pytestmark = pytest.mark.system

EXAMPLES = ROOT / "examples"


def example(folder: Path, plant: str, line: Path) -> str:
    """An example with another line."""
    file = EXAMPLES / plant
    text, lines = re.subn(r"serial: /dev/\w+|serial: /tmp/[\w-]+", f"serial: {line}", file.read_text("utf-8"))
    assert lines == 1
    (folder / "plant.yaml").write_text(text, "utf-8")
    for each in file.parent.iterdir():
        if each.suffix != ".yaml":
            (folder / each.name).symlink_to(each)
    return str(folder / "plant.yaml")


@pytest.mark.parametrize(
    ("device", "ready", "plant", "task"),
    [
        ("serial_arm", "--torque", "serial_arm/desk.yaml", "desk carry left right"),
        ("gcode", "--homed", "gantry/bench.yaml", "bench visit rack drill"),
        ("gcode", "--dialect=marlin", "gantry/marlin.yaml", "bench visit rack drill"),
    ],
)
@pytest.mark.smoke
def test_a_task_is_done_at_a_serial_line(
    start: Callable[..., Any],
    arboleda: Callable[..., Any],
    tmp_path: Path,
    device: str,
    ready: str,
    plant: str,
    task: str,
) -> None:
    line = tmp_path / "line"
    words = (device, ready, "--link", str(line))
    played = play(start, *words)
    second = typed(start, *words, "--fault-port", played.faults.split(":")[2].split("/")[0])
    assert second.wait() != 0 and "name another port" in second.output
    run = arboleda(
        "up", "--once", task, "--plant", example(tmp_path, plant, line), "--boards", "drivers", "--no-ros"
    )
    assert run.wait() == 0, run.output
    assert played.process.interrupt() == 0 and "Traceback" not in run.output + played.process.output
    assert not line.is_symlink()


@pytest.mark.smoke
def test_a_task_is_done_at_a_websocket(
    start: Callable[..., Any], arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    played = play(start, "gcode", "--dialect", "moonraker", "--port", "0")
    (port,) = played.found(r"is at ws://127.0.0.1:(\d+)/websocket")
    plant = (EXAMPLES / "gantry/moonraker.yaml").read_text("utf-8")
    assert "port: 7125" in plant
    (tmp_path / "plant.yaml").write_text(plant.replace("port: 7125", f"port: {port}"), "utf-8")
    (tmp_path / "recipes.py").symlink_to(EXAMPLES / "gantry/recipes.py")
    where = ("--plant", str(tmp_path / "plant.yaml"), "--boards", "drivers", "--no-ros")
    run = arboleda("up", "--once", "bench visit rack drill", *where)
    assert run.wait() == 0, run.output
    assert played.process.interrupt() == 0 and "Traceback" not in run.output + played.process.output
