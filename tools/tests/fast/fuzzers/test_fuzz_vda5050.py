"""A short run of tools/fuzz-vda5050, and that it finds what it is for."""

from __future__ import annotations

from typing import Any

import pytest
from tests.scripts import load

from arboleda_drivers.vda5050 import messages

RUNS = 1000


@pytest.fixture(scope="module")
def fuzz() -> Any:
    return load("fuzz-vda5050")


def test_nothing_is_raised_and_nothing_refused_counts(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert all(seen[what] > 0 for what in ("state refused", "state taken", "connection refused")), seen


@pytest.mark.long
def test_a_number_without_a_limit_would_be_found(fuzz: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(messages, "DIGITS", 4000)
    with pytest.raises(AssertionError, match="OverflowError"):
        fuzz.run(8000, 3)
