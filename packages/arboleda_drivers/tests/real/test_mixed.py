"""The example of several makers, as it is typed: its virtual controllers and its plant with one command."""

from __future__ import annotations

import socket
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.packages import ROOT

pytestmark = [pytest.mark.system, pytest.mark.requires("pymodbus")]

EXAMPLE = ROOT / "examples/mixed"


def free_ports(count: int) -> list[int]:
    with_all = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    found = [each.getsockname()[1] for each in with_all]
    for each in with_all:
        each.close()
    return found


def copied(tmp_path: Path) -> None:
    """The example, with ports that are free."""
    dobot, feedback, plc, broker = map(str, free_ports(4))
    texts = {file.name: file.read_text("utf-8") for file in EXAMPLE.iterdir() if file.is_file()}
    plant = {
        "{host: 127.0.0.1}": f"{{host: 127.0.0.1, port: {dobot}, feedback_port: {feedback}}}",
        "port: 5020": f"port: {plc}",
        "127.0.0.1:1884": f"127.0.0.1:{broker}",
    }
    other = {
        "plant.yaml": plant,
        "plant_ros2.yaml": plant,
        "start.py": {
            '"--enabled"': f'"--enabled", "--port", "{dobot}", "--feedback-port", "{feedback}"',
            '["modbus"]': f'["modbus", "--port", "{plc}"]',
            '["vda5050"]': f'["vda5050", "--port", "{broker}"]',
        },
    }
    for name, text in texts.items():
        for old, new in other.get(name, {}).items():
            assert old in text
            text = text.replace(old, new)
        (tmp_path / name).write_text(text, "utf-8")


def test_a_part_is_delivered_by_one_command(tmp_path: Path, start: Callable[..., Any]) -> None:
    copied(tmp_path)
    state = ("--state", str(tmp_path / "state"))
    plant = start(sys.executable, str(tmp_path / "start.py"), "line deliver slot_1 200", *state)
    plant.wait_for("done      line slot_1 200", patience_s=90)
    assert plant.interrupt() == 0, plant.output
    assert "stopping: whatever moves is halted" in plant.output
    assert "belt: still" in plant.output
    assert "Traceback" not in plant.output
