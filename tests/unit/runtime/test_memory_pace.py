"""Commits are timed around the store, and a slow one is told once until it is over."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest

from arboleda.adapters import clock
from arboleda.model.messages import Fact, Remember
from arboleda.runtime.parts.commit_pace import STALL_KEPT_S, Pace
from arboleda.runtime.parts.memory_pace import MemoryPace
from arboleda.store.sqlite import Store
from arboleda.wire.status import OK, WARN

LATCH = Remember(fact=Fact.LATCH, name="ra1", value="on")


class Time:
    def __init__(self) -> None:
        self.now = 100.0


class SlowStore(Store):
    """A store whose syncs take as long as somebody says."""

    def __init__(self, time: Time) -> None:
        super().__init__(Path(":memory:"))
        self.time, self.takes_s = time, 0.0

    def _wait_for_disk(self) -> None:
        self.time.now += self.takes_s


@pytest.fixture
def time(monkeypatch: pytest.MonkeyPatch) -> Time:
    moved = Time()
    monkeypatch.setattr(clock, "seconds", lambda: moved.now)
    return moved


def test_each_sync_is_timed_and_no_commit(time: Time) -> None:
    pace, lengths = MemoryPace(), list[float]()
    pace.observers.append(lengths.append)
    with SlowStore(time) as store:
        store.timing, store.takes_s = pace, 0.25
        store.keep(LATCH)
        store.times.note_run(5.0)
        assert lengths == []
        store.sync()
        assert lengths == [pytest.approx(0.25)]


def test_a_slow_disk_is_told_once_and_once_more_when_it_is_over(
    time: Time, caplog: pytest.LogCaptureFixture
) -> None:
    pace, told = MemoryPace(), list[Pace]()
    pace.listeners.append(told.append)
    with SlowStore(time) as store, caplog.at_level(logging.INFO):
        store.timing, store.takes_s = pace, 0.35
        pace.look()
        for _ in range(6):
            store.sync()
            pace.look()
        assert [each.is_slow for each in told] == [True]
        assert "waits 0.35 s for it now" in caplog.text
        assert pace.diagnosis()[2:4] == (WARN, str(pace.pace.sentence))
        store.takes_s = 0.001
        for _ in range(20):
            store.sync()
            pace.look()
        assert [each.is_slow for each in told] == [True, False] and "fast again" in caplog.text
        assert pace.diagnosis()[2] == OK


def test_a_commit_that_hangs_is_told_while_it_does(time: Time) -> None:
    pace = MemoryPace()
    with pace:
        time.now += 3.0
        pace.look()
        assert pace.pace.is_slow and pace.pace.worst_s == pytest.approx(3.0)
    time.now += STALL_KEPT_S + 0.1
    pace.look()
    assert not pace.pace.is_slow
