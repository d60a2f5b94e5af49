"""Degrees at the device edge."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.kinds.joints import Joint
from arboleda.wire.units import from_wire, to_wire


def joint(pinion_radius_m: float | None) -> Joint:
    return Joint(
        name="j", lower=-1, upper=1, speed=1, acceleration=1, step=0.01, pinion_radius_m=pinion_radius_m
    )


REVOLUTE, RACK = joint(None), joint(0.0225)


def test_a_revolute_joint_is_told_in_degrees() -> None:
    assert to_wire(REVOLUTE, math.pi / 4) == pytest.approx(45.0)


def test_a_rack_is_told_as_the_angle_of_its_pinion() -> None:
    assert to_wire(RACK, 0.1) == pytest.approx(math.degrees(0.1 / 0.0225))


@pytest.mark.parametrize("axis", [REVOLUTE, RACK], ids=["rad", "m"])
@given(value=st.floats(-10, 10))
def test_a_value_comes_back(axis: Joint, value: float) -> None:
    assert from_wire(axis, to_wire(axis, value)) == pytest.approx(value, abs=1e-12)
