"""The belt of the example behind its virtual PLC, as it is typed: at work, jammed, and gone in the middle."""

from __future__ import annotations

import re
import sys
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.packages import ROOT
from tests.patience import PATIENCE_S

pytestmark = [pytest.mark.system, pytest.mark.requires("pymodbus", "serial", "snap7", "asyncua")]

EXAMPLE = ROOT / "examples/plc_conveyor"
COMMAND = "from arboleda.cli.main import main; main()"


PLCS = {
    "modbus": ("plant.yaml", "port: 5020"),
    "s7": ("s7.yaml", "port: 1102"),
    "opcua": ("opcua.yaml", "127.0.0.1:4840"),
}
"""By protocol: the plant file of the example, and what it says of the port."""


@pytest.fixture(params=PLCS)
def plc(request: pytest.FixtureRequest, start: Callable[..., Any], tmp_path: Path) -> tuple[Any, str, str]:
    """A virtual PLC, the plant file that reaches it, and where its faults are."""
    file, usual = PLCS[request.param]
    given = ("virtual", request.param, "--port", "0", "--fault-port", "0")
    process = start(sys.executable, "-c", COMMAND, *given)
    process.wait_for("faults are switched on ")
    port = re.search(r"(?:speaks \w+ on |opc\.tcp://)\S+?:(\d+)", process.output)
    faults = re.search(r"switched on (\S+)", process.output)
    assert port and faults
    for name in (file, "recipes.py"):
        text = (EXAMPLE / name).read_text("utf-8")
        (tmp_path / name).write_text(text.replace(usual, re.sub(r"\d+$", port[1], usual)), "utf-8")
    return process, str(tmp_path / file), faults[1]


@pytest.mark.smoke
def test_a_part_is_carried_then_the_belt_jams_then_the_plc_is_gone(
    plc: tuple[Any, str, str], arboleda: Callable[..., Any]
) -> None:
    process, plant, faults = plc
    fault, said = (
        ("refuses_calls", "BadUserAccessDenied")
        if "opc.tcp" in process.output
        else (
            "gives_up",
            "gave up (jam) while doing load",
        )
    )
    up = arboleda("up", "line pass 400 #first", "--plant", plant, "--boards", "real", "--no-ros")
    up.wait_for("done      line 400")
    switch(f"{faults}/{fault}", "PUT")
    arboleda("submit", "line pass 200 #second", "--plant", plant).wait()
    up.wait_for(said)
    switch(f"{faults}/{fault}", "DELETE")
    arboleda("submit", "line pass 100 #third", "--plant", plant).wait()
    up.wait_for("belt advance exit 100")
    process.kill()
    up.wait_for("the link was lost while doing")
    assert up.interrupt() == 0, up.output
    assert "Traceback" not in up.output + process.output


@pytest.mark.parametrize("plc", ["opcua"], indirect=True)
def test_a_port_that_is_taken_is_said(plc: tuple[Any, str, str], start: Callable[..., Any]) -> None:
    taken = re.search(r"opc\.tcp://\S+?:(\d+)", plc[0].output)
    assert taken
    second = start(sys.executable, "-c", COMMAND, "virtual", "opcua", "--port", taken[1])
    assert second.wait() == 1
    assert taken[1] in second.output and "Traceback" not in second.output


def switch(fault: str, method: str) -> None:
    urllib.request.urlopen(urllib.request.Request(fault, method=method), timeout=PATIENCE_S).close()
