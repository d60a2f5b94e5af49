"""`arboleda prove` of a recipe whose end differs by the answer of a device: each way has its end."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from arboleda_proofs.testing import Sim

from .lamp import Prove
from .lamp import plant as plant
from .lamp import prove as prove

RIGHT = """
from arboleda.recipes import recipe, work


@recipe("shine", ends_with=[{"lamp.test": "good", "lamp.lit": True}, {"lamp.test": "bad", "lamp.lit": False}])
def shine(cell):
    lamp = cell.device("lamp")
    seen, on, off = lamp.test(), lamp.light(on=True), lamp.light(on=False)
    return work(seen, cell.choose(seen, {"good": on, "bad": off}))
"""
QUIET = RIGHT.replace('"good": on', '"good": cell.fallback(on, cell.wait(0.5))')


def test_an_end_of_another_answer_is_no_end_of_this_way(plant: Path, prove: Prove) -> None:
    recipes, tests = plant.parent / "small.py", plant.parent / "test_found.py"
    recipes.write_text(QUIET)
    said = prove("--fault", "refuses", "--tests", tests, ends=1)
    assert "lamp.lit is false, not true" in said and "BROKEN: 1 breach" in said
    namespace: dict[str, Any] = {}
    exec(tests.read_text(), namespace)
    (written,) = [each for name, each in namespace.items() if name.startswith("test_")]
    with pytest.raises(AssertionError):
        written(Sim(plant.parent))
    recipes.write_text(RIGHT)
    written(Sim(plant.parent))


def test_each_way_that_ends_as_it_says_is_sound(plant: Path, prove: Prove) -> None:
    (plant.parent / "small.py").write_text(RIGHT)
    prove("--fault", "refuses", "--fault", "reboot")
