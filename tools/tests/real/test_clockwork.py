"""The thread that says when a robot's move is over."""

import threading

import pytest
from tests.patience import PATIENCE_S

from arboleda_bench.clockwork import Clockwork


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
