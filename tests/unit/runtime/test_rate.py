"""Virtual robots that are faster than the real ones, of every kind."""

from __future__ import annotations

import pytest

from arboleda.kinds.arm import Arm
from arboleda.kinds.declared import Device
from arboleda.kinds.mobile import Mobile
from arboleda.runtime.rate import at_rate
from arboleda.testing import shipped

from ..kinds.lab import model


def test_arms_and_mobile_robots_move_so_many_times_as_fast() -> None:
    plain, fast = shipped("sis_a"), at_rate(shipped("sis_a"), 2.0)
    for before, after in zip(plain.robots.values(), fast.robots.values(), strict=True):
        if isinstance(before, Arm) and isinstance(after, Arm):
            assert [joint.speed * 2.0 for joint in before.joints] == [joint.speed for joint in after.joints]
            ramps = [joint.speed / joint.acceleration for joint in after.joints]
            assert ramps == pytest.approx([joint.speed / joint.acceleration / 2.0 for joint in before.joints])
        elif isinstance(before, Mobile) and isinstance(after, Mobile):
            assert after.speed == before.speed * 2.0


def test_what_a_device_does_takes_less_and_a_slow_one_is_waited_for_longer() -> None:
    assert baking(10.0) == (2.0, 30.0)
    assert baking(0.5) == (40.0, 60.0)


def baking(rate: float) -> tuple[float, float]:
    oven = at_rate(model(), rate).robots["oven"]
    assert isinstance(oven, Device)
    return oven.kind.verbs["bake"].takes_s, oven.kind.verbs["bake"].at_most_s


def test_a_slow_plant_has_longer_to_come_to_rest() -> None:
    plain = shipped("sis_a")
    assert at_rate(plain, 0.2).timing.stop_timeout_s == pytest.approx(5 * plain.timing.stop_timeout_s)
    assert at_rate(plain, 5.0).timing == plain.timing
