"""What is looked at again and again, such as whether commits are slow."""

from __future__ import annotations

import pytest
from tests.threads import AtOnce, stand_in

from arboleda.model.errors import ArboledaError
from arboleda.runtime.parts import periodic
from arboleda.runtime.parts.commit_pace import (
    FAST_S,
    KEPT_S,
    LEAST,
    RECENT,
    SLOW_S,
    STALL_KEPT_S,
    STALL_S,
    CommitPace,
)
from arboleda.runtime.parts.periodic import Periodic


def fed(*lengths: float) -> CommitPace:
    pace = CommitPace()
    for number, seconds in enumerate(lengths):
        pace.committed(seconds, float(number))
    return pace


def test_a_memory_that_has_committed_nothing_is_not_slow() -> None:
    assert not CommitPace().pace(0.0).is_slow


def test_commits_are_slow_where_their_median_is() -> None:
    pace = fed(*[0.01] * 9, *[0.3] * 11).pace(20.0)
    assert pace.is_slow and pace.typical_s == pytest.approx(0.3) and pace.worst_s == 0.3
    assert not fed(*[0.01] * 11, *[0.3] * 9).pace(20.0).is_slow


def test_a_few_commits_say_nothing_and_one_stall_says_enough() -> None:
    assert not fed(*[SLOW_S] * (LEAST - 1)).pace(5.0).is_slow
    assert fed(*[SLOW_S] * LEAST).pace(5.0).is_slow
    assert fed(0.001, STALL_S).pace(2.0).is_slow


def test_a_commit_that_hangs_is_told_before_it_is_over() -> None:
    pace = fed(0.001)
    assert not pace.pace(1.0, pending_s=STALL_S - 0.01).is_slow
    hanging = pace.pace(1.0, pending_s=7.0)
    assert hanging.is_slow and hanging.worst_s == 7.0 and "up to 7.00 s" in str(hanging.sentence)


def test_a_stall_is_over_after_a_minute_of_fast_commits() -> None:
    pace = fed(STALL_S)
    assert pace.pace(STALL_KEPT_S - 0.1).is_slow
    assert not pace.pace(STALL_KEPT_S + 0.1).is_slow


def test_slow_commits_must_be_clearly_fast_again_before_that_is_said() -> None:
    pace = fed(*[SLOW_S] * RECENT)
    assert pace.pace(20.0).is_slow
    between = (FAST_S + SLOW_S) / 2
    for number in range(RECENT):
        pace.committed(between, 20.0 + number)
    assert pace.pace(40.0).is_slow
    for number in range(RECENT):
        pace.committed(FAST_S / 2, 40.0 + number)
    fast = pace.pace(60.0)
    assert not fast.is_slow and "fast again" in str(fast.sentence)


def test_what_was_slow_long_ago_says_nothing_of_the_disk_of_now() -> None:
    pace = fed(*[SLOW_S] * RECENT)
    assert pace.pace(30.0).is_slow
    assert not pace.pace(KEPT_S + RECENT).is_slow


def test_all_are_looked_at_until_one_says_that_the_plant_must_end() -> None:
    seen: list[str] = []
    crashes: list[tuple[str, BaseException]] = []
    error = ArboledaError("gone")

    def fails() -> None:
        seen.append("fails")
        if len(seen) > 2:
            raise error

    part = Periodic("place", [lambda: seen.append("first"), fails], lambda *what: crashes.append(what))
    part.turn()
    assert seen == ["first", "fails"] and not crashes
    part.turn()
    assert crashes == [("place", error)]


def test_one_that_is_stopped_before_its_start_looks_at_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(periodic, AtOnce, monkeypatch)
    looks: list[int] = []
    part = Periodic("place", [lambda: looks.append(1)], lambda *_: None)
    part.stop()
    part.start()
    assert not looks


def test_its_thread_looks_and_after_a_crash_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(periodic, AtOnce, monkeypatch)
    monkeypatch.setattr(periodic, "LOOK_S", 0.0)
    crashes: list[str] = []
    looks: list[int] = []

    def fails() -> None:
        looks.append(1)
        if len(looks) == 3:
            raise ArboledaError("gone")

    part = Periodic("place", [fails], lambda name, _: crashes.append(name))
    part.start()
    part.stop()
    part.stop()
    assert len(looks) == 3 and crashes == ["place"]
