"""A short run of tools/fuzz-s7, and that it finds what it is for."""

from __future__ import annotations

from typing import Any

import pytest
from tests.scripts import load

pytestmark = [pytest.mark.system, pytest.mark.requires("snap7")]

RUNS = 1000


@pytest.fixture
def fuzz() -> Any:
    return load("fuzz-s7")


def test_a_frame_with_mistakes_becomes_no_value_and_one_that_did_would_be_found(
    fuzz: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    assert all(seen[what] > RUNS / 20 for what in ("read", "S7ProtocolError", "S7ConnectionError")), seen
    assert seen["unreadable"] and seen["RequestRefused"], seen
    monkeypatch.setattr(fuzz.Line, "read", lambda line, block: line.open() and bytes(block.length))
    with pytest.raises(AssertionError, match="became"):
        fuzz.run(RUNS, 1)
