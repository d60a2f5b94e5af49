"""The virtual action servers over ROS 2, and the drivers that reach them."""

from __future__ import annotations

import math
import queue
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest
from tests.patience import PATIENCE_S

from arboleda.drivers import (
    Driver,
    FollowPath,
    MotionState,
    MoveJoints,
    Receipt,
    Report,
    Stop,
    StopMode,
    Tokens,
)
from arboleda.kinds.declared import Device
from arboleda.kinds.floor import Placement
from arboleda.kinds.gripper import GripperSettings as KindSettings
from arboleda.kinds.gripper import gripper
from arboleda.kinds.mobile import Grid, Mobile
from arboleda.model.commands import Command
from arboleda.model.plant_model import Evidence, Link, Robot
from arboleda.testing.plants import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda_drivers.gripper_command.settings import Settings as GripperSettings
from arboleda_drivers.gripper_command.virtual.machine import FAULTS as GRIPPER_FAULTS
from arboleda_drivers.joint_trajectory.settings import Settings as ArmSettings
from arboleda_drivers.joint_trajectory.virtual.machine import FAULTS as ARM_FAULTS
from arboleda_drivers.nav2.pose import Pose
from arboleda_drivers.nav2.settings import ToPose, Waypoints
from arboleda_drivers.nav2.virtual.machine import FAULTS as BASE_FAULTS
from arboleda_drivers.virtual.faults import Faults

pytestmark = pytest.mark.system

ARM = StorageLayout(shipped("sis_c").cells[0]).arm
NAMES = tuple(joint.name for joint in ARM.joints)
GOAL = ARM.motion.quantised(tuple(math.radians(each) for each in (4, 2, -3, 0, 1, 0)))
JAW = Device(
    name="jaw",
    mqtt="jaw",
    link=Link.DRIVER,
    evidence=Evidence.IDS,
    timeout_s=5.0,
    kind=gripper.of(KindSettings()),
)

CART = Mobile(
    name="cart",
    mqtt="cart",
    link=Link.DRIVER,
    evidence=Evidence.IDS,
    timeout_s=30.0,
    model="cart",
    grid=Grid(origin=Placement(x=0.0, y=0.0), pitch=0.5),
    speed=1.0,
)


class Bench:
    """A driver that is heard by the test, and the faults of what it reaches."""

    def __init__(self, driver: Driver, device: Robot, faults: Faults) -> None:
        self.faults, self._device = faults, device
        self._start(driver)

    def _start(self, driver: Driver) -> None:
        self.driver, self._heard = driver, queue.Queue[Report]()
        driver.start([self._device], self._heard.put, time.monotonic)

    def restart(self, driver: Driver) -> None:
        """Go on with another driver, as a plant does that starts again."""
        self.driver.stop()
        self._start(driver)

    def until(self, holds: Callable[[Report], Any]) -> Report:
        """The next report that does."""
        while not holds(report := self._heard.get(timeout=PATIENCE_S)):
            pass
        return report

    def ready(self) -> Report:
        return self.until(lambda report: report.state is MotionState.STOPPED)


@pytest.fixture
def arm(ros_domain: int, quick_discovery: None) -> Iterator[Bench]:
    from arboleda_drivers.joint_trajectory.adapter import FollowJointTrajectory
    from arboleda_drivers.joint_trajectory.virtual.server import controller

    faults = Faults(ARM_FAULTS)
    action = ArmSettings().action
    virtual = controller(
        faults, action=action, joint_states="joint_states", joints=NAMES, rate=50.0, lan=False
    )
    virtual.start()
    bench = Bench(FollowJointTrajectory(ArmSettings()), ARM, faults)
    yield bench
    bench.driver.stop()
    virtual.stop()


@pytest.fixture(params=[False, True], ids=["single", "parallel"])
def jaw(request: pytest.FixtureRequest, ros_domain: int, quick_discovery: None) -> Iterator[Bench]:
    from arboleda_drivers.gripper_command.adapter import GripperCommand
    from arboleda_drivers.gripper_command.virtual.server import controller

    settings = GripperSettings(open=0.085, type="parallel" if request.param else "single")
    faults = Faults(GRIPPER_FAULTS)
    virtual = controller(
        faults,
        action=settings.action,
        parallel=request.param,
        joint_states="joint_states",
        joint=settings.joint,
        opened=0.085,
        part=0.04,
        speed=0.2,
        rate=50.0,
        lan=False,
    )
    virtual.start()
    bench = Bench(GripperCommand(settings), JAW, faults)
    yield bench
    bench.driver.stop()
    virtual.stop()


@pytest.fixture(params=[False, True], ids=["pose", "waypoints"])
def cart(request: pytest.FixtureRequest, ros_domain: int, quick_discovery: None) -> Iterator[Bench]:
    from arboleda_drivers.nav2.adapter import FollowWaypoints, NavigateToPose
    from arboleda_drivers.nav2.virtual.server import controller

    settings = Waypoints() if request.param else ToPose()
    faults = Faults(BASE_FAULTS)
    virtual = controller(
        faults,
        action=settings.action,
        waypoints=request.param,
        odometry=settings.odometry,
        localisation=settings.localisation,
        frame=settings.frame,
        start=Pose(0.0, 0.0, math.pi / 2),
        speed=2.0,
        rate=50.0,
        lan=False,
    )
    virtual.start()
    driver = FollowWaypoints(settings) if request.param else NavigateToPose(settings)
    bench = Bench(driver, CART, faults)
    yield bench
    bench.driver.stop()
    virtual.stop()


def told(id: str, verb: str, **values: float) -> Command:
    return JAW.kind.command(id=id, robot="jaw", verb=verb, values=values)


def go(id: str) -> MoveJoints:
    return MoveJoints(id=id, robot=ARM.name, q=GOAL)


def test_an_arm_is_halted_under_way_and_then_moved_in_its_time(arm: Bench) -> None:
    arm.ready()
    arm.driver.send(go("1"))
    arm.until(lambda report: report.q is not None and report.q[0] > GOAL[0] / 10)
    arm.driver.send(Stop(id="2", robot=ARM.name, mode=StopMode.HALT))
    halted = arm.until(lambda report: report.accepted == "2" and report.state is MotionState.STOPPED)
    assert halted.q is not None and not ARM.motion.stands_at(halted.q, GOAL) and halted.done is None
    arm.driver.send(go("3"))
    assert arm.until(lambda report: report.accepted == "3").state is MotionState.MOVING
    done = arm.until(lambda report: report.done == "3")
    assert done.q is not None and ARM.motion.stands_at(done.q, GOAL)


def test_a_later_start_hears_from_the_server_what_an_earlier_one_had_done(arm: Bench) -> None:
    from arboleda_drivers.joint_trajectory.adapter import FollowJointTrajectory

    boot = arm.ready().boot_id
    arm.driver.send(replace(go("9-1"), token="ab05ba000401"))
    arm.until(lambda report: report.done == "9-1")
    arm.restart(FollowJointTrajectory(ArmSettings()))
    known = arm.until(lambda report: report.receipt is not None)
    assert (known.receipt, known.boot_id) == (Receipt(9, 1, 1), boot)
    assert known.tokens == Tokens("ab05ba000401", "ab05ba000401")
    assert (known.accepted, known.done) == (None, None)


def test_a_server_that_vanishes_comes_back_as_a_boot(arm: Bench) -> None:
    boot = arm.ready().boot_id
    arm.faults.switch("vanish", on=True)
    arm.until(lambda report: "no action server" in str(report.lost))
    arm.faults.switch("vanish", on=False)
    assert arm.ready().boot_id != boot


def test_a_part_is_gripped_and_let_go(jaw: Bench) -> None:
    jaw.ready()
    jaw.driver.send(told("1", "close", width_mm=5.0, force_n=20.0))
    assert jaw.until(lambda report: report.fact("gripped")).fact("width_mm") == pytest.approx(40)
    jaw.driver.send(told("2", "open"))
    assert jaw.until(lambda report: report.fact("gripped") is False).fact("width_mm") == 85.0


def test_a_base_is_driven_over_its_nodes(cart: Bench) -> None:
    assert cart.ready().node == 0
    cart.driver.send(FollowPath(id="1", robot="cart", nodes=(0, 1, 4)))
    cart.until(lambda report: report.node == 1)
    assert cart.until(lambda report: report.done == "1").node == 4
