"""`arboleda.client` and plants that really run: the examples."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from .conftest import ROOT, paths

pytestmark = pytest.mark.system
PROPOSAL = ROOT / "examples/client/proposal_to_task.py"
PROPOSES = "\nassistants: submit\nassistant_limits: {cells: [cell]}\n"
EXAMPLE = ROOT / "examples/client/task_to_report.py"


@pytest.mark.smoke
def test_the_example_shows_a_task_from_its_submission_to_its_report(
    arboleda: Callable[..., Any], start: Callable[..., Any], free_port: int
) -> None:
    up = arboleda("up", "--no-ros", "--rate", "10", "--port", str(free_port))
    up.wait_for("HTTP API")
    url = f"http://127.0.0.1:{free_port}"
    ran = start(sys.executable, str(EXAMPLE), env={"PYTHONPATH": paths(), "PLANT": url})
    assert ran.wait() == 0, ran.output
    shown = ran.output
    assert "refused: '99' is not a station of sis_a" in shown
    states = [line.split()[1] for line in ran.lines if line.startswith("c-")]
    assert states[-1] == "failed" and "done" in states
    assert "cause: operator: an operator ended it: stop sis_a" in shown
    assert "advice: clear sis_a" in shown
    assert up.interrupt() == 0, up.output


def test_a_proposal_is_written_tried_approved_and_its_task_done(
    arboleda: Callable[..., Any], start: Callable[..., Any], free_port: int, tmp_path: Path
) -> None:
    program = "from arboleda.cli.main import main; main()"
    new = start(sys.executable, "-c", program, "new", str(tmp_path / "presses"), env={"PYTHONPATH": paths()})
    assert new.wait() == 0, new.output
    file = tmp_path / "presses" / "plant.yaml"
    file.write_text(file.read_text("utf-8") + PROPOSES, "utf-8")
    up = arboleda("up", "--no-ros", "--plant", str(file), "--port", str(free_port))
    up.wait_for("HTTP API")
    address = {"PLANT": f"http://127.0.0.1:{free_port}", "PYTHONPATH": paths()}
    ran = start(sys.executable, str(PROPOSAL), env=address)
    assert ran.wait() == 0, ran.output
    shown = ran.output
    assert "kept: None - problems: " in shown and "refused: the task has 2 words" in shown
    assert "+      <press_close/>" in shown and "simulated: held" in shown
    assert "approved by Ana - version 2" in shown and "the recipe was approved by Ana" in shown
    assert up.interrupt() == 0, up.output
