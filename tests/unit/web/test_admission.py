"""Who is cut where there are too many connections, and token buckets."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from arboleda.web.limits import Buckets
from arboleda.web.server import Admission


@dataclass(frozen=True, kw_only=True)
class Guest:
    number: int
    peer: str = "192.0.2.1"
    waits: bool = True
    looks: bool = False
    known: bool = False


def crowd(count: int, **facts: bool) -> list[Guest]:
    """Guests 0 to count - 1, each from an address of its own."""
    return [Guest(number=number, peer=f"192.0.2.{number}", **facts) for number in range(count)]


def cut(guests: list[Guest], newcomer: Guest, most: int = 8, others: int = 0) -> int | None:
    """The number of the one that goes when the newcomer joins the guests."""
    gone = Admission(most).surplus([*guests, newcomer], others, newcomer)
    return None if gone is None else gone.number


def test_nobody_goes_while_there_is_room() -> None:
    assert cut(crowd(7), Guest(number=7)) is None


def test_the_oldest_goes_and_not_the_newcomer() -> None:
    assert cut(crowd(8), Guest(number=8)) == 0


def test_connections_that_cannot_be_cut_count() -> None:
    assert cut(crowd(4), Guest(number=4), others=4) == 0


def test_who_is_being_answered_stays() -> None:
    busy = crowd(2, waits=False)
    assert cut([*busy, *crowd(8)[2:]], Guest(number=8)) == 2


def test_in_a_flood_the_oldest_that_only_looks_goes() -> None:
    stopping, looking = crowd(1, waits=False), crowd(8, waits=False, looks=True)[1:]
    assert cut([*stopping, *looking], Guest(number=8)) == 1


def test_where_everybody_is_being_answered_the_newcomer_goes() -> None:
    assert cut(crowd(8, waits=False), Guest(number=8)) == 8


def test_one_without_a_login_goes_before_an_older_one_that_has_it() -> None:
    known = crowd(4, known=True)
    assert cut([*known, *crowd(8)[4:]], Guest(number=8)) == 4


def test_known_ones_that_crowd_make_room_and_newcomers_do_not_push_each_other_out() -> None:
    known = crowd(7, known=True)
    assert cut([*known, Guest(number=7, peer="just came")], Guest(number=8)) == 0


def test_one_address_has_not_all_the_places() -> None:
    same = [Guest(number=number) for number in range(5)]
    assert cut([Guest(number=9, peer="192.0.2.2"), *same], Guest(number=10)) == 0


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
