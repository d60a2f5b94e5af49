"""The trial of a plant's own Python in this process: stands in for the other process that people get."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from arboleda.plant_file.python_uses import SourceSpot
from arboleda.plant_file.recipe_check import trial
from arboleda.plant_file.recipe_trial import TrialResult


def verdict(name: str, beside: Path | None, content: bytes, **_: bool) -> TrialResult:
    """As `recipe_trial.verdict`; this process forgets what the trial has imported of the plant."""
    before = set(sys.modules)
    try:
        found = trial(name, content, beside, _watched)
    finally:
        for each in set(sys.modules) - before:
            if _is_of_a_test(each):
                del sys.modules[each]
    return TrialResult(**json.loads(json.dumps(vars(found))))  # as it comes from another process


def _is_of_a_test(module: str) -> bool:
    file = getattr(sys.modules[module], "__file__", None)
    return file is not None and not any(file.startswith(each) for each in LASTING)


def _watched(spot: SourceSpot, doing: str) -> None:
    """A watch that ends nothing; steps that statements make are noted, as wherever somebody watches."""


LASTING = (sys.prefix, sys.base_prefix, str(Path(__file__).parents[1]))
