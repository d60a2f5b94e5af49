"""The belt of the example behind its virtual PLC of OPC UA, as it is typed: at work, at odds, and gone."""

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

pytestmark = [pytest.mark.system, pytest.mark.requires("asyncua")]

EXAMPLE = ROOT / "examples/plc_conveyor"
COMMAND = "from arboleda.cli.main import main; main()"


@pytest.fixture
def plc(start: Callable[..., Any], tmp_path: Path) -> tuple[Any, str, str]:
    """A virtual PLC, the plant file that reaches it, and where its faults are."""
    process = start(sys.executable, "-c", COMMAND, "virtual", "opcua", "--port", "0", "--fault-port", "0")
    process.wait_for("faults are switched on ")
    port = re.search(r"opc\.tcp://\S+:(\d+)", process.output)
    faults = re.search(r"switched on (\S+)", process.output)
    assert port and faults
    (tmp_path / "recipes.py").write_text((EXAMPLE / "recipes.py").read_text("utf-8"), "utf-8")
    text = (EXAMPLE / "opcua.yaml").read_text("utf-8").replace("127.0.0.1:4840", f"127.0.0.1:{port[1]}")
    (tmp_path / "opcua.yaml").write_text(text, "utf-8")
    return process, str(tmp_path / "opcua.yaml"), faults[1]


@pytest.mark.smoke
def test_a_part_is_carried_then_calls_are_refused_then_the_plc_is_gone(
    plc: tuple[Any, str, str], arboleda: Callable[..., Any], start: Callable[..., Any]
) -> None:
    process, plant, faults = plc
    up = arboleda("up", "line pass 400 #first", "--plant", plant, "--boards", "real", "--no-ros")
    up.wait_for("done      line 400")
    switch(f"{faults}/refuses_calls", "PUT")
    arboleda("submit", "line pass 200 #second", "--plant", plant).wait()
    up.wait_for("BadUserAccessDenied")
    second = start(sys.executable, "-c", COMMAND, "virtual", "opcua", "--port", port_of(plant))
    assert second.wait() == 1
    assert port_of(plant) in second.output and "Traceback" not in second.output
    switch(f"{faults}/refuses_calls", "DELETE")
    arboleda("submit", "line pass 100 #third", "--plant", plant).wait()
    up.wait_for("belt advance exit 100")
    process.kill()
    up.wait_for("the link was lost while doing")
    assert up.interrupt() == 0, up.output
    assert "Traceback" not in up.output + process.output


def switch(fault: str, method: str) -> None:
    urllib.request.urlopen(urllib.request.Request(fault, method=method), timeout=PATIENCE_S).close()


def port_of(plant: str) -> str:
    port = re.search(r"opc\.tcp://\S+:(\d+)", Path(plant).read_text("utf-8"))
    assert port
    return port[1]
