"""Shared zones: one robot each, first come first served, and quarantine that only people or proof end."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from arboleda.dispatch.zones import Zones
from arboleda.model.errors import IllegalTransition
from arboleda.views.zone_rows import zone_rows

A, B, C = "ra1", "ra2", "ra3"


def wanted(names: str) -> frozenset[str]:
    """`x y` -> the two zones."""
    return frozenset(names.split())


def zones(*requests: tuple[str, str]) -> Zones:
    """The zones x, y and z after these requests of (robot, zones)."""
    made = Zones("xyz")
    for robot, names in requests:
        made.acquire(robot, wanted(names))
    return made


def quarantined() -> Zones:
    """ra1 fell silent in x and y; ra2 waits for x and ra3 for y."""
    made = zones((A, "x y"), (B, "x"), (C, "y"))
    made.quarantine(A)
    return made


def test_all_zones_are_taken_at_once() -> None:
    plant = zones((A, "x y"))
    assert plant.held_by(A) == {"x", "y"}
    assert (plant.holder("x"), plant.holder("z"), plant.queue.waiting) == (A, None, ())


def test_or_none_of_them() -> None:
    plant = zones((A, "x"))
    assert plant.acquire(B, wanted("x y")) is False
    assert (plant.held_by(B), plant.queue.waiting) == (frozenset(), ((B, wanted("x y")),))


def test_asking_again_changes_nothing() -> None:
    plant = zones((A, "x y"), (B, "x"), (C, "x"))
    before = zone_rows(plant), plant.queue.waiting
    assert [plant.acquire(A, wanted(names)) for names in ("x y", "y", "")] == [True, True, True]
    assert [plant.acquire(B, wanted("x")), plant.acquire(C, wanted("x"))] == [False, False]
    assert (zone_rows(plant), plant.queue.waiting) == before


def test_nobody_gets_past_an_earlier_one_who_wants_the_same_zone() -> None:
    plant = zones((A, "x"), (B, "x y"))
    assert plant.acquire(C, wanted("y")) is False
    assert plant.release(A) == (B,)
    assert plant.release(B) == (C,)


def test_a_free_zone_that_nobody_earlier_wants_is_not_kept_back() -> None:
    assert zones((A, "x"), (B, "x y")).acquire(C, wanted("z")) is True


def test_one_release_may_serve_several_in_their_order() -> None:
    plant = zones((A, "x y z"), (C, "y"), (B, "x z"))
    assert plant.release(A) == (C, B)


def test_who_withdraws_lets_the_next_one_pass() -> None:
    plant = zones((A, "x"), (B, "x y"), (C, "y"))
    assert plant.withdraw(B) == (C,)
    assert (plant.queue.waiting, plant.withdraw(B)) == ((), ())


def test_a_ring_of_wishes_is_served_one_by_one() -> None:
    plant = zones((A, "x y"), (B, "y z"), (C, "z x"))
    assert (plant.release(A), plant.release(B), plant.release(C)) == ((B,), (C,), ())


REFUSED: dict[str, tuple[Callable[[], Zones], str, str, str]] = {
    "more while inside": (lambda: zones((A, "x")), A, "x y", "nobody standing in a zone waits for another"),
    "others while waiting": (lambda: zones((A, "x"), (B, "x")), B, "y", "waits for x and asks for y"),
    "unknown zone": (zones, A, "w x", 'there is no zone "w"; zones of this plant: x, y, z'),
    "while quarantined": (quarantined, A, "x", "before it is back, homed and seen outside"),
}


@pytest.mark.parametrize("case", REFUSED.values(), ids=REFUSED)
def test_an_impossible_request_is_refused_and_changes_nothing(
    case: tuple[Callable[[], Zones], str, str, str],
) -> None:
    make, robot, names, sentence = case
    plant = make()
    before = zone_rows(plant), plant.queue.waiting
    with pytest.raises(IllegalTransition, match=sentence):
        plant.acquire(robot, wanted(names))
    assert (zone_rows(plant), plant.queue.waiting) == before


def test_quarantine_outlives_a_release() -> None:
    plant = quarantined()
    assert plant.release(A) == plant.withdraw(A) == ()
    assert plant.held_by(A) == {"x", "y"}
    assert plant.is_quarantined("x") and not plant.is_quarantined("z")


def test_a_restored_robot_frees_all_its_zones() -> None:
    plant = quarantined()
    assert plant.restore(A) == (B, C)
    assert plant.acquire(A, wanted("z")) is True


def test_what_is_held_but_not_quarantined_is_not_freed_by_restore() -> None:
    plant = zones((A, "x"))
    assert (plant.restore(A), plant.holder("x")) == ((), A)


def test_an_operator_frees_one_zone_at_a_time() -> None:
    plant = quarantined()
    assert plant.override("y") == (C,)
    assert (plant.held_by(A), plant.held_by(C)) == ({"x"}, {"y"})
    assert plant.restore(A) == (B,)
    assert plant.held_by(C) == {"y"}


def test_a_robot_inside_takes_again_what_an_override_took_from_it() -> None:
    plant = zones((A, "x y"))
    assert plant.regain(A, wanted("x y z")) and plant.held_by(A) == {"x", "y"}, "it lacked nothing"
    plant.quarantine(A)
    plant.override("y")
    assert plant.regain(A, wanted("x y")) and plant.held_by(A) == {"x", "y"}


def test_a_robot_inside_gets_nothing_back_that_another_one_has_now() -> None:
    plant = quarantined()
    plant.override("y")
    assert not plant.regain(A, wanted("x y"))
    assert (plant.held_by(A), plant.held_by(C), plant.queue.waiting) == ({"x"}, {"y"}, ((B, wanted("x")),))
    plant.release(C)
    assert plant.regain(A, wanted("x y")) and plant.held_by(A) == {"x", "y"}


def test_a_robot_from_which_all_was_taken_asks_as_one_that_comes_from_outside() -> None:
    plant = zones((A, "x"))
    plant.quarantine(A)
    plant.override("x")
    assert plant.acquire(A, wanted("x y")) and plant.regain(A, wanted("x y z"))
    assert plant.held_by(A) == {"x", "y"}


def test_what_an_earlier_start_left_may_not_be_all_that_a_robot_needs() -> None:
    plant = Zones("xy", {"x": A})
    assert plant.regain(A, wanted("x y")) and plant.held_by(A) == {"x", "y"}


@pytest.mark.parametrize(
    ("zone", "sentence"),
    [("x", "zone x is held by ra1, which still reports"), ("y", "zone y is free"), ("w", 'no zone "w"')],
)
def test_only_a_quarantined_zone_can_be_overridden(zone: str, sentence: str) -> None:
    plant = zones((A, "x"))
    with pytest.raises(IllegalTransition, match=sentence):
        plant.override(zone)
    assert plant.holder("x") == A


def test_a_quarantine_survives_a_restart_of_the_plant() -> None:
    plant = Zones("xy", {"x": A, "gone": B})
    assert plant.acquire(B, wanted("x y")) is False
    assert (plant.is_quarantined("x"), plant.held_by(B)) == (True, frozenset())
    assert plant.restore(A) == (B,)


def test_a_screen_sees_plain_data() -> None:
    plant = quarantined()
    plant.override("y")
    assert zone_rows(plant) == [
        {"zone": "x", "state": "quarantined", "robot": A, "waiting": [B]},
        {"zone": "y", "state": "held", "robot": C, "waiting": []},
        {"zone": "z", "state": "free", "robot": None, "waiting": []},
    ]


def test_ahead_of_somebody_are_those_before_it_that_wait_for_one_of_the_same_zones() -> None:
    plant = zones(("ra4", "x y z"), (A, "x"), (B, "y"), (C, "y z"))
    assert [plant.queue.ahead_of(robot) for robot in (A, B, C)] == [(), (), (B,)]
