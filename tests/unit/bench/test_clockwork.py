"""The thread that says when a robot's move is over."""

import threading

import pytest

from arboleda_bench.clockwork import Clockwork

from ...patience import PATIENCE_S


@pytest.fixture
def clockwork():
    made = Clockwork()
    yield made
    made.stop()


def test_acts_come_in_the_order_of_their_times(clockwork):
    said: list[str] = []
    over = threading.Event()
    for seconds, word in ((0.02, "second"), (0.01, "first")):
        clockwork.after(seconds, lambda word=word: said.append(word))
    clockwork.after(0.03, over.set)
    clockwork.start()
    assert over.wait(PATIENCE_S)
    assert said == ["first", "second"]


def test_an_act_may_ask_for_the_next_one(clockwork):
    over = threading.Event()
    clockwork.start()
    clockwork.after(0.0, lambda: clockwork.after(0.0, over.set))
    assert over.wait(PATIENCE_S)


def test_what_recurs_goes_on(clockwork):
    thrice = threading.Semaphore(0)
    clockwork.every(0.001, thrice.release)
    clockwork.start()
    assert all(thrice.acquire(timeout=PATIENCE_S) for _ in range(3))


def test_after_the_end_nothing_comes(clockwork):
    said: list[str] = []
    clockwork.start()
    clockwork.after(3600.0, lambda: said.append("late"))
    clockwork.stop()
    clockwork.stop()
    assert said == []
