"""The figures of how long a robot moves on whose teacher is lost."""

from __future__ import annotations

import pytest

from arboleda_kills.deadman import share


@pytest.mark.parametrize(("part", "value"), [(0.5, 2.0), (0.99, 4.0), (0.25, 1.0), (0.0, 1.0)])
def test_a_share_is_what_so_many_do_not_exceed(part: float, value: float) -> None:
    assert share([4.0, 1.0, 3.0, 2.0], part) == value
