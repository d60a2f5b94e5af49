"""A short run of tools/fuzz-actions, and that it finds what it is for."""

from __future__ import annotations

from typing import Any

import pytest
from tests.lengths import length
from tests.scripts import load

from arboleda_drivers.nav2 import pose
from arboleda_drivers.ros_action import joints

pytestmark = pytest.mark.requires("rclpy")

RUNS = length(150, whole=400)
ENOUGH, SEED = 100, 5  # to find what is planted


@pytest.fixture(scope="module")
def fuzz() -> Any:
    return load("fuzz-actions")


@pytest.mark.long
def test_nothing_is_raised_and_nothing_refused_counts(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert all(seen[what] > 0 for what in ("refused", "measured", "said")), seen


@pytest.mark.parametrize("module", [joints, pose])
def test_a_number_without_a_limit_would_be_found(
    fuzz: Any, module: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "FAR", float("inf"))
    with pytest.raises(AssertionError):
        fuzz.run(ENOUGH, SEED)
