"""The plant's clock."""

from __future__ import annotations

import time

import pytest

from arboleda.adapters import clock


@pytest.mark.skipif(not hasattr(time, "CLOCK_BOOTTIME"), reason="only Linux has this clock")
def test_it_counts_the_time_in_which_the_machine_is_suspended(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[int] = []
    monkeypatch.setattr(time, "clock_gettime", lambda which: read.append(which) or 7.5)
    assert clock.seconds() == 7.5
    assert read == [time.CLOCK_BOOTTIME]


def test_it_never_goes_back() -> None:
    assert clock.seconds() <= clock.seconds()


def test_elsewhere_it_is_the_monotonic_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clock, "BOOT", None)
    monkeypatch.setattr(time, "monotonic", lambda: 3.0)
    assert clock.seconds() == 3.0
