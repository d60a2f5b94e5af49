"""The page on robots that move: its driver turns a table."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

PAGE = (Path(__file__).parents[2] / "docs/how-to/add-a-moving-robot.md").read_text("utf-8")
PYTHON = PAGE.split("```python\n")[1].partition("```")[0]
PLANT = PAGE.split("```yaml\n")[1].partition("```")[0]

pytestmark = pytest.mark.system


@pytest.fixture
def plant(tmp_path: Path) -> str:
    (tmp_path / "turntable.py").write_text(PYTHON, "utf-8")
    (tmp_path / "plant.yaml").write_text(PLANT, "utf-8")
    return str(tmp_path / "plant.yaml")


def test_its_driver_turns_the_table(arboleda: Callable[..., Any], plant: str) -> None:
    run = arboleda("up", "--once", "bay left", "--plant", plant, "--no-ros")
    assert run.wait() == 0, run.output
    assert "done      bay left" in run.output and "Traceback" not in run.output
