"""One source of limits and speeds: URDF, plant model and virtual board say the same."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any

import pytest

from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.robot_models import arm_models, mobile_models
from arboleda.plant_file.urdf import prefix, robot_urdf
from arboleda.sim.devices import Devices
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire import units
from arboleda.wire.payloads import JointsGoal
from arboleda_description.urdf import render

from .drawn import moving, read

ARMS = ["ra1", "ra2", "ra3"]
MOBILES = ["rm_sis_a", "rm_sis_b", "rm_sis_c"]
A_LITTLE_DEG = 0.001


@pytest.fixture(params=["as shipped", "narrowed"])
def plant(request: pytest.FixtureRequest, narrowed: PlantModel) -> PlantModel:
    return narrowed if request.param == "narrowed" else shipped()


def limits(text: str) -> list[tuple[str, float, float, float]]:
    """Name, lower, upper and speed of each joint that moves."""
    rows = ((joint.name, joint.limit) for joint in moving(read(text)))
    return [(name, limit.lower, limit.upper, limit.velocity) for name, limit in rows]


def board(plant: PlantModel, name: str) -> Any:
    """The body of a robot's virtual board."""
    devices = Devices(plant, now=0.0, boot_ids=lambda: 1)
    return devices.boards[plant.robots[name].mqtt].body


def goal(arm: Arm, index: int, value: float, beyond_deg: float = 0.0) -> JointsGoal:
    """All joints at 0 but one, as it is asked for on the wire."""
    q = [0.0] * len(arm.joints)
    q[index] = units.to_wire(arm.joints[index], value) + beyond_deg
    return JointsGoal(q_deg=tuple(q), seq=1, epoch=1)


@pytest.mark.parametrize("model", ["scara", "cr10a"])
def test_a_drawing_by_itself_has_the_limits_of_its_model(model: str) -> None:
    joints = arm_models()[model].joints
    expected = [(joint.name, joint.lower, joint.upper, joint.speed) for joint in joints]
    assert limits(render(model, prefix="")) == expected


def test_a_mobile_by_itself_stays_on_the_grid_that_a_plant_file_has_by_default() -> None:
    far, speed = StorageLayout(shipped().cells[2]).mobile.grid.position(8), mobile_models()["mobile"].speed
    assert limits(render("mobile", prefix="")) == [
        ("x_joint", 0, far[0], speed),
        ("y_joint", 0, far[1], speed),
    ]


@pytest.mark.parametrize("name", ARMS)
def test_an_arm_of_a_plant_is_drawn_with_the_limits_of_the_plant(plant: PlantModel, name: str) -> None:
    arm = plant.robots[name]
    assert isinstance(arm, Arm)
    expected = [(f"{arm.twin}_{each.name}", each.lower, each.upper, each.speed) for each in arm.joints]
    assert limits(robot_urdf(plant, name)) == expected


@pytest.mark.parametrize("name", MOBILES)
def test_a_mobile_of_a_plant_is_drawn_as_far_as_its_grid_and_as_fast(plant: PlantModel, name: str) -> None:
    mobile = plant.robots[name]
    assert isinstance(mobile, Mobile)
    far = 2 * mobile.grid.pitch
    rows = limits(robot_urdf(plant, name))
    assert rows == [(f"{prefix(mobile)}{axis}_joint", 0, far, mobile.speed) for axis in "xy"]


def test_what_the_plant_file_narrows_is_narrower_in_the_drawing(narrowed: PlantModel) -> None:
    q1, q2, q3 = limits(robot_urdf(narrowed, "ra1"))
    assert q1[1:] == pytest.approx((math.radians(-90), math.radians(80), math.radians(90)))
    assert q2[1:] == pytest.approx((math.radians(-135), math.radians(135), math.radians(30)))
    assert q3[1:] == pytest.approx((0, 0.06, 0.06))
    assert limits(robot_urdf(narrowed, "rm_sis_a"))[0][1:] == pytest.approx((0, 0.7, 0.05))


@pytest.mark.parametrize("name", ARMS)
def test_a_board_goes_as_far_as_the_drawing_and_no_whole_motor_step_further(
    plant: PlantModel, name: str
) -> None:
    arm, body = plant.robots[name], board(plant, name)
    for index, (_, lower, upper, _) in enumerate(limits(robot_urdf(plant, name))):
        assert body.admits(goal(arm, index, lower)) and body.admits(goal(arm, index, upper))
        beyond = units.to_wire(arm.joints[index], arm.joints[index].step) / 2 + A_LITTLE_DEG
        assert not body.admits(goal(arm, index, lower, -beyond))
        assert not body.admits(goal(arm, index, upper, beyond))


@pytest.mark.sampled(6)
@pytest.mark.parametrize("name", ARMS)
def test_a_board_moves_as_fast_as_the_drawing_and_no_faster(plant: PlantModel, name: str) -> None:
    arm, body = plant.robots[name], board(plant, name)
    clock = itertools.count(step=5_000)
    for index, (_, lower, upper, velocity) in enumerate(limits(robot_urdf(plant, name))):
        speeds = [
            speed for end in (lower, upper) for speed in driving(body, goal(arm, index, end), index, clock)
        ]
        interval_us = 1e6 * arm.joints[index].step / velocity
        assert 1e6 / max(speeds) == pytest.approx(interval_us, abs=1)  # a board counts whole microseconds


def driving(body: Any, to: JointsGoal, index: int, clock: Iterator[int]) -> Iterator[float]:
    """How fast a joint is on its way there, in motor steps/s, every 5 ms."""
    body.start(next(clock), to)
    while body.moving:
        body.advance(next(clock))
        yield body.motors.speeds[index]
