"""The belt of the example behind its virtual PLC, as it is typed: at work, jammed, and gone in the middle."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.packages import ROOT

from ..played import Played, play, typed

pytestmark = [pytest.mark.system, pytest.mark.requires("pymodbus", "serial", "snap7", "asyncua")]

EXAMPLE = ROOT / "examples/plc_conveyor"
PLCS = {
    "modbus": ("plant.yaml", "port: 5020"),
    "s7": ("s7.yaml", "port: 1102"),
    "opcua": ("opcua.yaml", "127.0.0.1:4840"),
}
"""By protocol: the plant file of the example, and what it says of the port."""


@pytest.fixture(params=PLCS)
def plc(request: pytest.FixtureRequest, start: Callable[..., Any], tmp_path: Path) -> tuple[Played, str, str]:
    """A virtual PLC, its port, and the plant file that reaches it."""
    file, usual = PLCS[request.param]
    played = play(start, request.param, "--port", "0")
    (port,) = played.found(r"(?:speaks \w+ on |opc\.tcp://)\S+?:(\d+)")
    for name in (file, "recipes.py"):
        text = (EXAMPLE / name).read_text("utf-8")
        (tmp_path / name).write_text(text.replace(usual, re.sub(r"\d+$", port, usual)), "utf-8")
    return played, port, str(tmp_path / file)


@pytest.mark.smoke
def test_a_part_is_carried_then_the_work_breaks_off_then_the_plc_is_gone(
    plc: tuple[Played, str, str], arboleda: Callable[..., Any]
) -> None:
    played, _, plant = plc
    fault, said = "gives_up", "gave up (jam) while doing load"
    if plant.endswith("opcua.yaml"):
        fault, said = "refuses_calls", "BadUserAccessDenied"
    up = arboleda("up", "line pass 400 #first", "--plant", plant, "--boards", "real", "--no-ros")
    up.wait_for("done      line 400")
    played.switch(fault, on=True)
    arboleda("submit", "line pass 200 #second", "--plant", plant).wait()
    up.wait_for(said)
    played.switch(fault, on=False)
    arboleda("submit", "line pass 100 #third", "--plant", plant).wait()
    up.wait_for("belt advance exit 100")
    played.process.kill()
    up.wait_for("the link was lost while doing")
    assert up.interrupt() == 0, up.output
    assert "Traceback" not in up.output + played.process.output


@pytest.mark.parametrize("plc", ["opcua"], indirect=True)
def test_a_port_that_is_taken_is_said(plc: tuple[Played, str, str], start: Callable[..., Any]) -> None:
    second = typed(start, "opcua", "--port", plc[1], "--fault-port", "0")
    assert second.wait() == 1
    assert plc[1] in second.output and "Traceback" not in second.output
