"""What moves have in common is stepped through once; that courses are right is for the tests of the axis."""

from __future__ import annotations

import pytest

from arboleda.sim.course import Course
from arboleda.sim.stepper import Pace, Stepper

SPEED, ACCELERATION = 2003.0, 1009.0  # 1988 steps to full speed; no other test has these


@pytest.fixture
def stepped(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Grows by one with every step that any stepper takes."""
    times: list[int] = []
    step = Stepper.step

    def counted(self: Stepper, now_us: int) -> None:
        times.append(now_us)
        step(self, now_us)

    monkeypatch.setattr(Stepper, "step", counted)
    return times


def pace_from_rest() -> Pace:
    stepper = Stepper()
    stepper.set_max_speed(SPEED)
    stepper.set_acceleration(ACCELERATION)
    stepper.move_to(1)
    return stepper.pace


def test_moves_that_get_to_full_speed_differ_in_how_long_they_keep_it(stepped):
    first = Course(SPEED, ACCELERATION, 5000, pace_from_rest())
    assert len(stepped) > 3900  # up and down
    stepped.clear()
    second = Course(SPEED, ACCELERATION, 7000, pace_from_rest())
    assert len(stepped) < 300
    assert second.duration_us - first.duration_us == 2000 * int(1e6 / SPEED)


def test_a_shorter_move_is_stepped_through_on_its_way_down_only(stepped):
    Course(SPEED, ACCELERATION, 5000, pace_from_rest())
    stepped.clear()
    Course(SPEED, ACCELERATION, 2000, pace_from_rest())
    assert 990 < len(stepped) < 1300
