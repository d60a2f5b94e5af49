"""A defect of one cell in the real process: the process stays, the other cells work, the log has it whole."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from .conftest import SHIPPED, paths

pytestmark = [pytest.mark.system]
BROKEN = {
    "a rule": """
from arboleda.dispatch import evidence
sound = evidence._work_by_ids
def broken(entry, belief, report):
    if entry.cell == "sis_a":
        raise KeyError("by design")
    return sound(entry, belief, report)
for key in [key for key, rule in evidence.RULES.items() if rule is sound]:
    evidence.RULES[key] = broken
""",
    "a leaf": """
from arboleda.trees.leaves import Announce
sound = Announce.update
def broken(self):
    if self.context.cell.name == "sis_a":
        raise KeyError("by design")
    return sound(self)
Announce.update = broken
""",
}


@pytest.mark.parametrize("defect", BROKEN)
def test_what_raises_in_one_cell_ends_its_task_and_nothing_else(
    start: Callable[..., Any], tmp_path: Path, defect: str
) -> None:
    plant_file = yaml.safe_load(SHIPPED.read_text())
    for cell in plant_file["cells"].values():
        cell["on_absence"] = "go_on"  # a busy machine may keep the whole process from working for a while
    (tmp_path / "plant.yaml").write_text(yaml.safe_dump(plant_file))
    main = f"{BROKEN[defect]}\nfrom arboleda.cli.main import main; main()"
    tasks = ("sis_a 0B 7", "sis_b 1C 3")
    state = ("--state", str(tmp_path / "state"), "--plant", str(tmp_path / "plant.yaml"))
    command = (sys.executable, "-c", main, "run", *tasks, "--no-ros", "--rate", "10", *state)
    plant = start(*command, env={"PYTHONPATH": paths()})
    assert plant.wait() == 1
    assert "Traceback" not in plant.output
    assert "internal error in sis_a (KeyError: 'by design')" in plant.output
    rows = [line for line in plant.lines if line.startswith("│") and "sis_" in line]
    assert "failed" in next(row for row in rows if "sis_a" in row)
    assert "done" in next(row for row in rows if "sis_b" in row)
    log = (tmp_path / "state" / "arboleda.log").read_text()
    assert log.count("Traceback") == 1 and "by design" in log
