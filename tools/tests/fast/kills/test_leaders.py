"""Commands of two leaders at the boards."""

from __future__ import annotations

import pytest

from arboleda_kills.hosts.run import two_leaders

ONE_BY_ONE = [(1.0, "ra1", "7-1"), (2.0, "ra1", "7-2"), (3.0, "ra1", "8-1"), (3.1, "ra2", "8-2")]


def test_leaders_one_after_the_other_are_no_breach() -> None:
    assert two_leaders(ONE_BY_ONE) == []


@pytest.mark.parametrize("robot", ["ra1", "ra2"], ids=["of the same robot", "of another robot"])
def test_a_command_of_the_leader_before_is_a_breach(robot: str) -> None:
    late = (4.0, robot, "7-3")
    assert two_leaders([*ONE_BY_ONE, late]) == [f"{robot} accepted 7-3 after a command of plant 8"]


def test_what_two_boards_accepted_may_be_told_in_another_order() -> None:
    assert two_leaders([*ONE_BY_ONE, (3.2, "ra3", "7-3")]) == []
