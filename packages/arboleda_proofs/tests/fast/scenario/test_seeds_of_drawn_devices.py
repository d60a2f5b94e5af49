"""Seeds of drawn plants that were wrong once, each under its setting, as they are drawn today."""

from __future__ import annotations

from typing import Any

import pytest
from tests.lengths import sample

from arboleda_drawn.plants import DrawnPlants
from arboleda_proofs.campaigns.setting import Setting

CYCLES = 20
ONCE_WRONG: list[tuple[str, int, dict[str, Any]]] = [
    (
        "a tool that was given up told too early that it had let go",
        67570,
        {"level": "normal", "standby": True},
    ),
    ("a move that had not left was over once it was called off", 70575, {"level": "crashes"}),
    (
        "a plant died in the step that gave a switch up, which the next start tries again",
        67815,
        {"level": "crashes"},
    ),
    ("a clamp opened at an open door only, and its door stood closed", 67515, {"level": "crashes"}),
    ("tasks that came after the last fault had no time to end", 67677, {"level": "crashes"}),
    ("a switch that left late had as much more to settle", 71079, {"level": "crashes"}),
    ("an operator had a clamp let go whose task was held", 141260, {"level": "many"}),
    ("a mill was halted before slow reports told of its order", 73844, {"level": "many"}),
    ("a clamp that a person had emptied was handed on at once", 145107, {"level": "crashes"}),
    ("a washer had forgotten a moment ago what was switched", 73646, {"level": "many"}),
]


@pytest.mark.long
@pytest.mark.parametrize(
    ("seed", "given"), [pytest.param(s, g, id=why) for why, s, g in sample(ONCE_WRONG, 2)]
)
def test_every_invariant_holds(seed: int, given: dict[str, Any]) -> None:
    result = Setting(plants=DrawnPlants(), cycles=CYCLES, **given).run(seed)
    assert result.broken is None, str(result.broken)
    assert result.outcomes.get("done", 0) > 0
