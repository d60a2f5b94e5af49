"""A short run of tools/fuzz-pylabrobot, and that it finds what it is for."""

from __future__ import annotations

from typing import Any

import pytest
from tests.scripts import load

from arboleda_drivers.pylabrobot import machine

RUNS = 2000


@pytest.fixture
def fuzz() -> Any:
    return load("fuzz-pylabrobot")


def test_nothing_is_raised_and_nothing_is_done_without_a_return(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    assert all(seen[what] > RUNS / 100 for what in ("done", "failed", "lost", "open")), seen


def test_a_driver_that_takes_begun_for_done_would_be_found(
    fuzz: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    tell = machine.Machine._tell
    monkeypatch.setattr(
        machine.Machine,
        "_tell",
        lambda self, now, **ids: tell(self, now, **ids, done=next(iter(ids.values()))),
    )
    with pytest.raises(AssertionError, match="have not returned"):
        fuzz.run(RUNS, 1)
