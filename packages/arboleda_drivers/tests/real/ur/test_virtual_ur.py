"""The example of a UR10e against the virtual one, as it is typed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.packages import ROOT

from ..played import play

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
    any_port = [word for name in ("port", "rtde-port", "script-port") for word in (f"--{name}", "0")]
    played = play(start, "ur", "--running", *any_port)
    ports = played.found(r"dashboard (\d+), RTDE (\d+), programs (\d+)")
    said = "port: {}, rtde_port: {}, script_port: {}".format(*ports)
    plant = example(tmp_path, said)
    up = arboleda("up", "bench load", "--plant", plant, "--boards", "drivers", "--no-ros")
    up.wait_for("done      bench")
    played.switch("protective_stop", on=True)
    arboleda("submit", "bench load").wait()
    up.wait_for("arm: gave up (protective_stop) while")
    played.switch("protective_stop", on=False)
    assert arboleda("home", "arm").wait() == 0
    assert up.interrupt() == 0, up.output
    assert played.process.interrupt() == 0 and "Traceback" not in up.output + played.process.output
