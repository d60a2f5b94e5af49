"""Motions at the device edge: degrees, goals that a robot can never carry out, how long beats are needed."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.kinds.joints import Joint, MoveJoints
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import Evidence
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire.forms import form_of
from arboleda.wire.motion import LINGER_S, OpenMotion
from arboleda.wire.units import from_wire, to_wire
from arboleda.wire.values import Telemetry


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


ARM = StorageLayout(shipped("sis_a").cell("sis_a")).arm


@pytest.mark.parametrize(("beyond", "word"), [(0.0, None), (0.9e-6, None), (1.1e-6, "limite")])
def test_a_goal_beyond_its_limit_by_more_than_float32_loses_is_refused(
    beyond: float, word: str | None
) -> None:
    for joint in range(len(ARM.joints)):
        for limit, sign in ((ARM.joints[joint].upper, 1.0), (ARM.joints[joint].lower, -1.0)):
            q = tuple(limit + sign * beyond if each == joint else 0.0 for each in range(len(ARM.joints)))
            assert form_of(ARM).refusal(ARM, MoveJoints(id="1-1", robot=ARM.name, q=q)) == word


ELSEWHERE, GOAL = (0.5, 0.5, 0.5), (0.1, 0.2, 0.05)


def said(state: MotionState) -> Telemetry:
    return Telemetry(state=state, q_deg=ELSEWHERE, node=None)


def test_a_board_that_names_no_command_has_stood_still_for_as_long_as_it_drives_on() -> None:
    arm = StorageLayout(shipped("sis_a", evidence=Evidence.JOINTS).cells[0]).arm
    motion = OpenMotion(robot=arm, command=MoveJoints(id="1-1", robot=arm.name, q=GOAL), seq=1)
    heard = [
        (10.0, MotionState.STOPPED, False),  # it has not begun
        (30.0, MotionState.MOVING, False),
        (31.0, MotionState.STOPPED, False),
        (31.0 + LINGER_S / 2, MotionState.STOPPED, False),
        (31.0 + LINGER_S, MotionState.STOPPED, True),
    ]
    for at, state, ended in heard:
        assert motion.ended(at, said(state), ELSEWHERE, frozenset()) is ended, at
