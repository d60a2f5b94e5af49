from __future__ import annotations

import pytest

from arboleda.dashboard.twin import track

SPEEDS = (1.0, 0.5)


@pytest.mark.parametrize(
    ("seconds", "expected"),
    [(0.0, [0, 0]), (0.1, [0.1, -0.05]), (0.5, [0.5, -0.2]), (9.0, [1, -0.2]), (-1.0, [0, 0])],
)
def test_every_joint_goes_to_its_goal_and_stays_there(seconds: float, expected: list[float]) -> None:
    assert track.towards((0, 0), (1, -0.2), SPEEDS, seconds) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("seconds", "expected"),
    [(0, [0, 0]), (1, [0.2, 0]), (1.5, [0.2, 0.1]), (2, [0.2, 0.2]), (60, [0.2, 0.2])],
)
def test_a_way_is_followed_piece_by_piece_to_its_end(seconds: float, expected: list[float]) -> None:
    assert track.along([[0, 0], [0.2, 0], [0.2, 0.2]], 0.2, seconds) == pytest.approx(expected)


def test_a_way_may_begin_where_it_goes() -> None:
    assert track.along([[1, 1], [1, 1]], 0.2, 5) == [1, 1]
    with pytest.raises(ValueError, match="at least one point"):
        track.along([], 0.2, 5)


def test_positions_are_apart_as_soon_as_one_joint_is() -> None:
    assert not track.apart((0, 0), (0.09, 0.04), SPEEDS, 0.1)
    assert track.apart((0, 0), (0.09, 0.06), SPEEDS, 0.1)
