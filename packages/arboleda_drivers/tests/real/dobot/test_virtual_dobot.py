"""The shipped plant with its CR10A behind the driver `dobot`, as it is typed, against the virtual one."""

from __future__ import annotations

import json
import re
import sys
import urllib.request
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
from tests.patience import PATIENCE_S

pytestmark = pytest.mark.system

LINK = "      twin: r3\n      link: mqtt\n"
COMMAND = "from arboleda.cli.main import main; main()"


@pytest.fixture
def controller(start: Callable[..., Any]) -> tuple[Any, str, str]:
    """A virtual Dobot, the line of the plant file that reaches it, and where its faults are."""
    ports = ("--port", "0", "--feedback-port", "0", "--fault-port", "0")
    process = start(sys.executable, "-c", COMMAND, "virtual", "dobot", "--enabled", *ports)
    process.wait_for("faults are switched on ")
    ports_of = re.search(r"dashboard (\d+), feedback (\d+)", process.output)
    faults = re.search(r"switched on (\S+)", process.output)
    assert ports_of and faults
    line = f"driver: {{dobot: {{host: 127.0.0.1, port: {ports_of[1]}, feedback_port: {ports_of[2]}}}}}"
    return process, line, faults[1]


def shipped(folder: Path, line: str) -> str:
    """The shipped plant file with that line in the place of ra3's link."""
    text = (files("arboleda") / "plants/plant.yaml").read_text("utf-8")
    assert LINK in text
    (folder / "plant.yaml").write_text(text.replace(LINK, f"      twin: r3\n      {line}\n"), "utf-8")
    return str(folder / "plant.yaml")


def switch(faults: str, name: str, method: str) -> dict[str, Any]:
    request = urllib.request.Request(f"{faults}/{name}", method=method)
    with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
        found: dict[str, Any] = json.load(answer)
    return found


@pytest.mark.smoke
def test_a_part_is_stored_by_a_dobot_and_a_collision_fails_the_next(
    controller: tuple[Any, str, str], arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    process, line, faults = controller
    up = arboleda("up", "sis_c 0B 7", "--plant", shipped(tmp_path, line), "--boards", "drivers", "--no-ros")
    up.wait_for("done      sis_c 0B 7")
    assert switch(faults, "collision", "PUT")["collision"]["on"] is True
    arboleda("submit", "sis_c palletizing").wait()
    up.wait_for("ra3: gave up (collision) while")
    assert switch(faults, "collision", "DELETE")["collision"]["on"] is False
    assert up.interrupt() == 0, up.output
    assert process.interrupt() == 0 and "Traceback" not in up.output + process.output
