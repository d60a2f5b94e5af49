"""A short run of tools/fuzz-dobot, and that it finds what it is for."""

from __future__ import annotations

from typing import Any

import pytest
from tests.scripts import load

from arboleda_drivers.dobot import frames

RUNS = 2000


@pytest.fixture
def fuzz() -> Any:
    return load("fuzz-dobot")


def test_nothing_is_raised_and_nothing_refused_counts(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    assert all(seen[what] > RUNS / 100 for what in ("frame refused", "frame read", "connection closed")), seen


def test_a_check_of_frames_that_is_missing_would_be_found(fuzz: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(frames, "FARTHEST_DEG", 1e300)
    with pytest.raises(AssertionError, match="of seed 1"):
        fuzz.run(RUNS, 1)
