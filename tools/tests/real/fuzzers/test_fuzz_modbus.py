"""A short run of tools/fuzz-modbus, and that it finds what it is for."""

from __future__ import annotations

from typing import Any

import pytest
from tests.scripts import load

pytestmark = [pytest.mark.system, pytest.mark.requires("pymodbus")]

RUNS = 2000


@pytest.fixture
def fuzz() -> Any:
    return load("fuzz-modbus")


def test_a_frame_with_mistakes_becomes_no_value_and_one_that_did_would_be_found(
    fuzz: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    assert all(seen[what] > RUNS / 50 for what in ("read", "unreadable", "ConnectionException")), seen
    monkeypatch.setattr(fuzz.Line, "read", lambda *_: [0] * 13)
    with pytest.raises(AssertionError, match="became"):
        fuzz.run(RUNS, 1)
