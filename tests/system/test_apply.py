"""A change of the plant file of a plant that runs, put to work by commands as a person types them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.system

EXAMPLE = Path(__file__).parents[2] / "examples/own_tree"


def test_what_changed_since_the_start_is_said_and_the_next_start_has_it(
    arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    for name in ("plant.yaml", "tend.xml"):
        (tmp_path / name).write_bytes((EXAMPLE / name).read_bytes())
    plant = tmp_path / "plant.yaml"
    up = arboleda("up", "--no-ros", "--plant", str(plant))
    up.wait_for("HTTP API")
    plant.write_text(plant.read_text("utf-8").replace("takes_s: 20", "takes_s: 25"), "utf-8")
    applied = arboleda("apply", "--plant", str(plant), "--yes")
    assert applied.wait() == 0, applied.output
    assert "compared with what the plant was started with" in applied.output
    assert "kinds.mill.verbs.run.takes_s: from 20 to 25" in applied.output
    assert at_work(arboleda, plant) == ["  1  "]
    assert up.interrupt() == 0
    again = arboleda("up", "--no-ros", "--plant", str(plant))
    again.wait_for("HTTP API")
    assert at_work(arboleda, plant) == ["  2  "]
    assert again.interrupt() == 0


def at_work(arboleda: Callable[..., Any], plant: Path) -> list[str]:
    """The numbers of the versions that are listed as at work, as they begin their lines."""
    listed = arboleda("versions", "--plant", str(plant))
    assert listed.wait() == 0, listed.output
    return [line[:5] for line in listed.output.splitlines() if "at work" in line]
