"""Garbage is collected between the steps of a plant."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from typing import Any
from unittest import mock

import pytest

from arboleda.adapters import clock
from arboleda.runtime.parts import garbage as garbage_part
from arboleda.runtime.parts.garbage import SHARE, Garbage, leave_out_more

OFTEN = (700, 10, 10)
MOST_YOUNG = 10_000
PLANT: Any = None  # nothing is asked of it


class Collections:
    """The generations that were collected, in order; a collection takes `takes_s`."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.found: list[int] = []
        self.now = 0.0
        self.takes_s = 0.0
        monkeypatch.setattr(clock, "seconds", lambda: self.now)

    def heard(self, phase: str, info: dict[str, int]) -> None:
        if phase == "stop":
            self.found.append(info["generation"])
            self.now += self.takes_s


@pytest.fixture
def collections(monkeypatch: pytest.MonkeyPatch) -> Iterator[Collections]:
    before, heard = gc.get_threshold(), Collections(monkeypatch)
    gc.set_threshold(*OFTEN)
    gc.callbacks.append(heard.heard)
    try:
        yield heard
    finally:
        gc.callbacks.remove(heard.heard)
        gc.set_threshold(*before)


@pytest.fixture
def garbage(collections: Collections, monkeypatch: pytest.MonkeyPatch) -> Iterator[Garbage]:
    """What other tests have made stays left out meanwhile: it takes long to look at."""
    monkeypatch.setattr(garbage_part, "YOUNG", OFTEN[0])
    monkeypatch.setattr(garbage_part, "MOST_YOUNG", MOST_YOUNG)
    made = Garbage()
    with mock.patch.object(gc, "get_freeze_count", return_value=0), mock.patch.object(gc, "unfreeze"):
        made.start(has_steps=True)
        collections.found.clear()
        try:
            yield made
        finally:
            made.stop()


@pytest.fixture
def thawed() -> Iterator[mock.Mock]:
    """Nothing is left out, as where a plant is a process of its own; what collects everything is called and
    does not look at all that other tests have made."""
    gc.unfreeze()
    with mock.patch.object(gc, "collect") as collect:
        yield collect
    gc.freeze()


def test_nothing_is_collected_in_the_middle_of_a_step(collections: Collections, garbage: Garbage) -> None:
    kept: list[list[int]] = [[] for _ in range(2 * OFTEN[0])]
    assert collections.found == []
    garbage.stepped(PLANT)
    assert collections.found == [0]
    garbage.stepped(PLANT)
    assert collections.found == [0]
    assert kept


def test_a_thread_that_makes_no_step_does_not_fill_the_memory(
    collections: Collections, garbage: Garbage
) -> None:
    assert [[] for _ in range(2 * MOST_YOUNG)]
    assert collections.found


def test_older_objects_are_collected_as_often_as_python_would(
    collections: Collections, garbage: Garbage
) -> None:
    kept: list[list[int]] = []
    for _ in range(OFTEN[1] + 2):
        kept += ([] for _ in range(2 * OFTEN[0]))
        garbage.stepped(PLANT)
    assert collections.found.count(1) == 1


def test_collections_of_everything_take_a_small_share_of_the_time(
    collections: Collections, garbage: Garbage
) -> None:
    collections.takes_s = 0.1
    for _ in range(OFTEN[2] + 1):
        gc.collect(1)
    garbage.stepped(PLANT)
    assert collections.found[-1] == 2
    for _ in range(OFTEN[2] + 1):
        gc.collect(1)
    garbage.stepped(PLANT)
    assert collections.found.count(2) == 1
    collections.now += collections.takes_s / SHARE
    garbage.stepped(PLANT)
    assert collections.found.count(2) == 2


def test_what_was_there_before_is_left_out_until_the_end(collections: Collections, thawed: mock.Mock) -> None:
    garbage = Garbage()
    leave_out_more()
    assert gc.get_freeze_count() == 0
    garbage.start(has_steps=False)
    thawed.assert_not_called()
    before = gc.get_freeze_count()
    assert before > 0
    loaded_later: list[list[int]] = [[] for _ in range(100)]
    leave_out_more()
    assert gc.get_freeze_count() >= before + len(loaded_later)
    assert gc.get_threshold() == OFTEN
    garbage.stop()
    assert gc.get_freeze_count() == 0


def test_who_has_seen_to_it_is_left_alone(collections: Collections) -> None:
    gc.freeze()
    garbage = Garbage()
    garbage.start(has_steps=True)
    assert gc.get_threshold() == OFTEN
    garbage.stop()
    assert gc.get_freeze_count() > 0
