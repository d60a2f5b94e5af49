"""A short run of scripts/fuzz-vda5050, and that it finds what it is for."""

from __future__ import annotations

from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from typing import Any

import pytest

from arboleda.adapters.vda5050 import messages

SCRIPT = Path(__file__).parents[2] / "scripts" / "fuzz-vda5050"
RUNS = 1000


@pytest.fixture(scope="module")
def fuzz() -> Any:
    loader = SourceFileLoader("fuzz_vda5050", str(SCRIPT))
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None
    module = module_from_spec(spec)
    loader.exec_module(module)
    return module


def test_nothing_is_raised_and_nothing_refused_counts(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert all(seen[what] > 0 for what in ("state refused", "state taken", "connection refused")), seen


def test_a_number_without_a_limit_would_be_found(fuzz: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(messages, "DIGITS", 4000)
    with pytest.raises(AssertionError, match="OverflowError"):
        fuzz.run(8000, 3)
