"""Token buckets."""

from __future__ import annotations

import pytest

from arboleda.web.limits import Buckets


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


def test_a_burst_then_a_rate(clock: Clock) -> None:
    buckets = Buckets((2.0, 3), clock)
    assert [buckets.take("a") for _ in range(4)] == [True, True, True, False]
    clock.now = 0.4
    assert not buckets.take("a")
    clock.now = 0.5
    assert buckets.take("a") and not buckets.take("a")


def test_rest_saves_up_no_more_than_a_burst(clock: Clock) -> None:
    buckets = Buckets((2.0, 3), clock)
    buckets.take("a")
    clock.now = 1e6
    assert [buckets.take("a") for _ in range(4)] == [True, True, True, False]


def test_each_client_has_its_own(clock: Clock) -> None:
    buckets = Buckets((1.0, 1), clock)
    assert buckets.take("a") and buckets.take("b") and not buckets.take("a")


def test_looking_takes_nothing(clock: Clock) -> None:
    buckets = Buckets((1.0, 1), clock)
    assert not buckets.empty("a") and not buckets.empty("a")
    assert buckets.take("a") and buckets.empty("a")


def test_a_delay_keeps_to_the_rate(clock: Clock) -> None:
    buckets = Buckets((2.0, 2), clock)
    assert [buckets.delay_s("a") for _ in range(5)] == [0.0, 0.0, 0.5, 1.0, 1.5]
    clock.now = 1.5
    assert buckets.delay_s("a") == 0.5


def test_no_number_of_clients_fills_the_memory(clock: Clock) -> None:
    buckets = Buckets((1.0, 1), clock, most=2)
    for name in "abc":
        assert buckets.take(name)
    assert buckets.take("a") and not buckets.take("c")
