"""Messages pushed through something, in time that is moved by hand."""

from __future__ import annotations

from collections import deque

import pytest

from arboleda.model.errors import ArboledaError
from arboleda_bench.flow import NUMBERS, PUMP_S, WINDOW, Flow


class Pipe:
    """Pipe that gives at the next pump what it was given; every `drops`th message is lost."""

    def __init__(self, drops: int = 0) -> None:
        self.now = 0.0
        self.flow = Flow(
            ("a", "b"),
            send=self._send,
            pump=self._pump,
            number_of=lambda n: n % NUMBERS,
            clock=lambda: self.now,
        )
        self._inside: deque[tuple[str, int]] = deque()
        self._drops = drops
        self._count = 0

    def _send(self, source: str, number: int) -> None:
        self._count += 1
        if not self._drops or self._count % self._drops:
            self._inside.append((source, number))

    def _pump(self, seconds: float) -> None:
        self.now += seconds
        for _ in range(len(self._inside)):
            self.flow.arrive(*self._inside.popleft())


def test_a_rate_is_that_of_full_windows():
    pipe = Pipe()
    assert pipe.flow.rate(2.0) == pytest.approx(2 * WINDOW / PUMP_S, rel=0.02)
    assert pipe.flow.sent == pipe.flow.arrived


def test_latencies_are_of_evenly_spaced_messages():
    pipe = Pipe()
    took = pipe.flow.latencies(per_second=10.0, seconds=20.0)
    assert len(took) == 200
    assert max(took) == pytest.approx(PUMP_S)


def test_what_is_lost_shows_in_the_counts():
    pipe = Pipe(drops=10)
    took = pipe.flow.latencies(per_second=10.0, seconds=10.0)
    assert (len(took), pipe.flow.sent - pipe.flow.arrived) == (90, 10)


def test_nothing_that_comes_through_is_an_error():
    with pytest.raises(ArboledaError, match="nothing comes through"):
        Pipe(drops=1).flow.rate(1.0)
