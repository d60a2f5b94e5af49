"""A short run of scripts/fuzz-dobot, and that it finds what it is for."""

from __future__ import annotations

from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from typing import Any

import pytest

from arboleda.drivers.dobot import frames

SCRIPT = Path(__file__).parents[2] / "scripts" / "fuzz-dobot"
RUNS = 2000


@pytest.fixture
def fuzz() -> Any:
    loader = SourceFileLoader("fuzz_dobot", str(SCRIPT))
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None
    module = module_from_spec(spec)
    loader.exec_module(module)
    return module


def test_nothing_is_raised_and_nothing_refused_counts(fuzz: Any) -> None:
    seen, _ = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    assert all(seen[what] > RUNS / 100 for what in ("frame refused", "frame read", "connection closed")), seen


def test_a_check_of_frames_that_is_missing_would_be_found(fuzz: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(frames, "FARTHEST_DEG", 1e300)
    with pytest.raises(AssertionError, match="of seed 1"):
        fuzz.run(RUNS, 1)
