"""A short run of tools/fuzz-opcua, and that it finds what it is for."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from tests.lengths import length
from tests.scripts import load

pytestmark = pytest.mark.requires("asyncua")

RUNS = length(500, 2000)


@pytest.fixture
def fuzz() -> Any:
    return load("fuzz-opcua")


def test_an_answer_with_mistakes_becomes_no_report(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    assert all(seen[what] > RUNS / 50 for what in ("read", "unreadable", "undecodable")), seen


def test_a_wrong_answer_that_was_read_would_be_found(fuzz: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    device = SimpleNamespace(places=("ns=2;s=done",), report=lambda at, read: "a report")
    monkeypatch.setattr(fuzz, "OpcUaDevice", lambda *_: device)
    with pytest.raises(AssertionError, match="became a report"):
        fuzz.run(RUNS, 1)
