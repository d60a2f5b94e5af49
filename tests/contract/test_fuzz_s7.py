"""A short run of scripts/fuzz-s7, and that it finds what it is for."""

from __future__ import annotations

from typing import Any

import pytest

from ..scripts import load

pytestmark = [pytest.mark.system, pytest.mark.requires("snap7")]

RUNS = 1000


@pytest.fixture
def fuzz() -> Any:
    return load("fuzz-s7")


def test_a_frame_with_mistakes_becomes_no_value(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    assert all(seen[what] > RUNS / 20 for what in ("read", "S7ProtocolError", "S7ConnectionError")), seen
    assert seen["unreadable"] and seen["RequestRefused"], seen


def test_a_wrong_frame_that_was_read_would_be_found(fuzz: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fuzz.Line, "read", lambda line, block: line.open() and bytes(block.length))
    with pytest.raises(AssertionError, match="became"):
        fuzz.run(RUNS, 1)
