"""A short run of scripts/fuzz-modbus, and that it finds what it is for."""

from __future__ import annotations

from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from typing import Any

import pytest

pytestmark = [pytest.mark.system, pytest.mark.requires("pymodbus")]

SCRIPT = Path(__file__).parents[2] / "scripts" / "fuzz-modbus"
RUNS = 2000


@pytest.fixture
def fuzz() -> Any:
    loader = SourceFileLoader("fuzz_modbus", str(SCRIPT))
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None
    module = module_from_spec(spec)
    loader.exec_module(module)
    return module


def test_a_frame_with_mistakes_becomes_no_value(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    assert all(seen[what] > RUNS / 50 for what in ("read", "unreadable", "ConnectionException")), seen


def test_a_wrong_frame_that_was_read_would_be_found(fuzz: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fuzz.Line, "read", lambda *_: [0] * 13)
    with pytest.raises(AssertionError, match="became"):
        fuzz.run(RUNS, 1)
