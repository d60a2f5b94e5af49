"""The example of a UR10e against the virtual one, as it is typed."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from dobot.test_virtual_dobot import COMMAND, switch
from tests.packages import ROOT

pytestmark = pytest.mark.system

EXAMPLE = ROOT / "examples/ur"


def example(folder: Path, ports: str) -> str:
    """The example with the ports of a virtual controller."""
    text = (EXAMPLE / "ur10e.yaml").read_text("utf-8")
    assert "host: 127.0.0.1," in text and "models/ur10e.urdf" in text
    text = text.replace("host: 127.0.0.1,", f"host: 127.0.0.1, {ports},")
    (folder / "plant.yaml").write_text(text, "utf-8")
    for name in ("recipes.py", "models"):
        (folder / name).symlink_to(EXAMPLE / name)
    return str(folder / "plant.yaml")


@pytest.mark.smoke
def test_a_part_is_carried_and_home_leads_out_of_a_protective_stop(
    start: Callable[..., Any], arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    any_port = [
        word for name in ("port", "rtde-port", "script-port", "fault-port") for word in (f"--{name}", "0")
    ]
    controller = start(sys.executable, "-c", COMMAND, "virtual", "ur", "--running", *any_port)
    controller.wait_for("faults are switched on ")
    ports = re.search(r"dashboard (\d+), RTDE (\d+), programs (\d+)", controller.output)
    faults = re.search(r"switched on (\S+)", controller.output)
    assert ports and faults
    said = "port: {}, rtde_port: {}, script_port: {}".format(*ports.groups())
    plant = example(tmp_path, said)
    up = arboleda("up", "bench load", "--plant", plant, "--boards", "drivers", "--no-ros")
    up.wait_for("done      bench")
    switch(faults[1], "protective_stop", "PUT")
    arboleda("submit", "bench load").wait()
    up.wait_for("arm: gave up (protective_stop) while")
    switch(faults[1], "protective_stop", "DELETE")
    assert arboleda("home", "arm").wait() == 0
    assert up.interrupt() == 0, up.output
    assert controller.interrupt() == 0 and "Traceback" not in up.output + controller.output
