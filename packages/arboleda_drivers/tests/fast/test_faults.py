"""Each driver in a plant under faults of its virtual controller; `tools/driver-faults` runs more seeds."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import pytest
from tests.lengths import sample

from arboleda.dispatch import evidence
from arboleda.kinds.joints.motion import JointMotion
from arboleda.kinds.mobile.motion import GridMotion
from arboleda_driver_faults.modbus import Registers
from arboleda_driver_faults.nav2 import BASE_CAUSES
from arboleda_driver_faults.rig import TASKS, run
from arboleda_driver_faults.rigs import rig_of
from arboleda_driver_faults.ros_action import CAUSES as ACTION_CAUSES
from arboleda_drivers.connections.receipts import Look
from arboleda_drivers.dobot import frames
from arboleda_drivers.dobot import work as dobot_work
from arboleda_drivers.dobot.virtual.machine import FAULTS as DOBOT_FAULTS
from arboleda_drivers.gcode import grbl_book, grbl_work, marlin, moonraker_work
from arboleda_drivers.gcode.virtual.faults import GRBL_FAULTS, MARLIN_FAULTS, MOONRAKER_FAULTS
from arboleda_drivers.gripper_command.machine import GripperMover
from arboleda_drivers.gripper_command.virtual.machine import FAULTS as GRIPPER_FAULTS
from arboleda_drivers.joint_trajectory.virtual.machine import FAULTS as ARM_FAULTS
from arboleda_drivers.modbus.virtual.memory import FAULTS as MODBUS_FAULTS
from arboleda_drivers.nav2.virtual.machine import FAULTS as BASE_FAULTS
from arboleda_drivers.opcua.virtual.command import FAULTS as OPCUA_FAULTS
from arboleda_drivers.plc.numbers import Numbers
from arboleda_drivers.pylabrobot.adapter import Bench
from arboleda_drivers.ros_action import machine as ros_machine
from arboleda_drivers.ros_action.goal import Rest
from arboleda_drivers.s7.virtual.memory import FAULTS as S7_FAULTS
from arboleda_drivers.serial_arm import work as serial_work
from arboleda_drivers.serial_arm.position_watch import PositionWatch
from arboleda_drivers.serial_arm.virtual.faults import FAULTS as SERVO_FAULTS
from arboleda_drivers.ur import work as ur_work
from arboleda_drivers.ur.arm_state import Runtime
from arboleda_drivers.ur.virtual.faults import FAULTS as UR_FAULTS
from arboleda_drivers.vda5050 import stops
from arboleda_drivers.vda5050.virtual.faults import FAULTS as AGV_FAULTS

PART_MM = 40.0
DEAF_AND_REFUSED = 98  # a cancel that is never begun, while an order is refused its update
CARRY_FAULTS = [*(f"arm.{name}" for name in ARM_FAULTS), *(f"jaw.{name}" for name in GRIPPER_FAULTS)]
OWN = ("jaw.empty", "jaw.slip", "jaw.jam", "jaw.allow_stalling", "arm.no_joint", "jaw.no_joint")
CART_FAULTS = [f"cart.{name}" for name in BASE_FAULTS]
CART = ("lie", "early", "short", "stuck", "jump", "unlocalised", "no_odometry")


@dataclass(frozen=True, kw_only=True)
class Driver:
    """Trial of a driver: its seeds, and the faults that come by themselves, in so many tasks."""

    known: Collection[str] = ()
    seeds: Collection[int]
    alone: Iterable[str] = ()
    few: int = 2
    tasks: int = TASKS
    marks: tuple[pytest.MarkDecorator, ...] = ()


MANY, SOME = sample(range(12), every=4), sample(range(8), every=4)
SHAKER = Driver(seeds=SOME, marks=(pytest.mark.requires("pylabrobot"),))
AGV = Driver(known=AGV_FAULTS, seeds=sample(range(8), every=2))
DRIVERS = {  # by the names of `tools/driver-faults`
    "dobot": Driver(known=DOBOT_FAULTS, seeds=MANY, alone=sample(DOBOT_FAULTS, every=2)),
    "ur": Driver(known=UR_FAULTS, seeds=MANY, alone=sample(UR_FAULTS, every=2)),
    "gcode-grbl": Driver(known=GRBL_FAULTS, seeds=SOME, alone=sample(GRBL_FAULTS, every=3), few=1),
    "gcode-limp": Driver(known=GRBL_FAULTS, seeds=SOME),
    "gcode-marlin": Driver(known=MARLIN_FAULTS, seeds=SOME, alone=sample(MARLIN_FAULTS, every=3), few=1),
    "gcode-moonraker": Driver(
        known=MOONRAKER_FAULTS, seeds=SOME, alone=sample(MOONRAKER_FAULTS, every=3), few=1
    ),
    "serial_arm-feetech": Driver(
        known=SERVO_FAULTS,
        seeds=sample(range(4), every=4),
        alone=sample(SERVO_FAULTS, every=3),
        few=1,
        tasks=TASKS // 2,
    ),
    "serial_arm-dynamixel": Driver(known=SERVO_FAULTS, seeds=sample(range(4), every=4), tasks=TASKS // 2),
    "modbus": Driver(known=MODBUS_FAULTS, seeds=range(4), alone=MODBUS_FAULTS),
    "opcua": Driver(known=OPCUA_FAULTS, seeds=range(4), alone={"mute", *OPCUA_FAULTS} - {*MODBUS_FAULTS}),
    "s7": Driver(known=S7_FAULTS, seeds=range(4), alone=("mute", "refuses_reads", "refuses_writes")),
    "navigate_to_pose": Driver(known=CART_FAULTS, seeds=range(2), alone=[f"cart.{each}" for each in CART]),
    "follow_waypoints": Driver(known=CART_FAULTS, seeds=range(2), alone=["cart.missed"], few=TASKS),
    "ros2_control": Driver(
        known=CARRY_FAULTS,
        seeds=range(4),
        alone=sample([*(f"arm.{name}" for name in ACTION_CAUSES), *OWN], every=2),
    ),
    "pylabrobot": SHAKER,
    "pylabrobot-side_by_side": SHAKER,
    "vda5050-2.0": AGV,
    "vda5050-2.1": replace(AGV, alone=sample(AGV_FAULTS, every=2)),
    "vda5050-3.0": AGV,
}


def breaches(driver: str, seed: int, *names: str, tasks: int = TASKS) -> list[str]:
    return run(rig_of(driver), seed, names, tasks).breaches


def seeded() -> Iterator[Any]:
    """All drivers with their seeds; the first one of each by day."""
    for name, driver in DRIVERS.items():
        for at, seed in enumerate(driver.seeds):
            yield pytest.param(name, seed, marks=[*driver.marks, *([pytest.mark.long] if at else [])])


@pytest.mark.parametrize(("driver", "seed"), [*seeded()])
def test_no_false_success_no_hang_and_the_right_cause(driver: str, seed: int) -> None:
    assert breaches(driver, seed, tasks=DRIVERS[driver].tasks) == []


@pytest.mark.sampled(7)
@pytest.mark.parametrize(
    ("driver", "fault"),
    [(name, fault) for name, driver in DRIVERS.items() for fault in sorted(driver.alone)],
)
def test_every_fault_by_itself(driver: str, fault: str) -> None:
    assert breaches(driver, 1, fault, tasks=DRIVERS[driver].few) == []


@pytest.mark.requires("pylabrobot")
def test_every_fault_of_a_shaker_by_itself() -> None:
    rig = rig_of("pylabrobot")
    assert [fault for fault in rig.faults.known if breaches("pylabrobot", 1, fault, tasks=1)] == []


def test_a_cancel_that_is_never_begun_is_said_again_until_it_is() -> None:
    assert breaches("vda5050-2.1", DEAF_AND_REFUSED) == []


def test_a_place_that_a_boot_has_lost_is_not_believed() -> None:
    assert [each for seed in range(4) for each in breaches("gcode-limp", seed, "boot")] == []


@pytest.mark.parametrize(
    "driver", [pytest.param(name, marks=driver.marks) for name, driver in DRIVERS.items()]
)
def test_every_fault_has_the_reasons_that_it_may_give(driver: str) -> None:
    rig = rig_of(driver)
    assert set(rig.causes) == set(DRIVERS[driver].known or rig.faults.known)


# What would be found if a driver, or the plant, were wrong.

Patch = pytest.MonkeyPatch


@dataclass(frozen=True, kw_only=True)
class Bug:
    """A bug, and the words of a breach that these seeds have with these faults; () are all faults."""

    driver: str
    plant: Callable[[Patch], None]
    faults: tuple[str, ...] = ()
    seeds: Collection[int] = (1,)
    tasks: int = TASKS
    found: str
    marks: list[pytest.MarkDecorator] = field(default_factory=list)


def believes_joints(patch: Patch) -> None:
    patch.setattr(JointMotion, "stands_at", lambda self, position, goal: True)


def believes_bases(patch: Patch) -> None:
    patch.setattr(GridMotion, "stands_at", lambda self, position, goal: True)


def believes_facts(patch: Patch) -> None:
    patch.setattr(evidence, "reached", lambda entry, belief: True)


def believes_servos(patch: Patch) -> None:
    believes_joints(patch)
    patch.setattr(PositionWatch, "stuck", lambda self: [])


def believes_before_rest(patch: Patch) -> None:
    patch.setattr(Rest, "holds", lambda self, now, since=0.0: True)
    patch.setitem(BASE_CAUSES, "early", set())


def believes_grips(patch: Patch) -> None:
    def shows(self: GripperMover, *, busy: bool) -> dict[str, object]:
        return {"facts": () if busy else (("gripped", self.width_mm < PART_MM),)}

    patch.setattr(GripperMover, "objection", lambda self, goal: "")
    patch.setattr(GripperMover, "shows", shows)


def ends_a_dobot_without_its_number(patch: Patch) -> None:
    def idle(self: dobot_work.Move, now: float, feedback: frames.Feedback) -> Look:
        return Look(done=self.number is not None and feedback.mode is frames.Mode.IDLE)

    patch.setattr(dobot_work.Move, "look", idle)


def ends_a_ur_without_its_number(patch: Patch) -> None:
    def look(self: ur_work.Move, now: float, frame: Any) -> Look:
        return Look(accepted=True, done=frame.runtime == Runtime.STOPPED)

    patch.setattr(ur_work.Move, "look", look)


def ends_servos_at_once(patch: Patch) -> None:
    patch.setattr(serial_work.Move, "look", lambda self, now, picture: Look(accepted=True, done=True))


def ends_at_the_ok(patch: Patch) -> None:
    def look(self: grbl_work.Move, now: float, status: object, alarm: object) -> grbl_work.GrblLook:
        return grbl_work.GrblLook(done=now > self.taken_at)

    patch.setattr(grbl_work.Move, "look", look)


def trusts_a_place_after_a_boot(patch: Patch) -> None:
    patch.setattr(grbl_book.Book, "lose", grbl_book.Book.trust)


def hears_no_switch(patch: Patch) -> None:
    patch.setattr(marlin.Marlin, "_take_trouble", lambda self, now, word: None)


def sends_pieces_twice(patch: Patch) -> None:
    send = moonraker_work.Requests.script

    def twice(self: moonraker_work.Requests, ask: moonraker_work.Ask, *lines: str) -> None:
        for _ in range(2 if ask is moonraker_work.Ask.PIECE else 1):
            send(self, ask, *lines)

    patch.setattr(moonraker_work.Requests, "script", twice)


def knows_no_numbers(patch: Patch) -> None:
    patch.setattr(Numbers, "id_of", lambda self, number: None)


def orders_twice(patch: Patch) -> None:
    once = Registers.order
    patch.setattr(Registers, "order", lambda wire, told: once(wire, told) or once(wire, told))


def never_gives_up_a_switch(patch: Patch) -> None:
    patch.setattr(ros_machine, "SPARE_S", 1e6)


def says_a_cancel_once(patch: Patch) -> None:
    patch.setattr(stops, "AGAIN_S", math.inf)


def takes_exceptions_for_returns(patch: Patch) -> None:
    one = Bench._one

    async def quiet(bench: Bench, call: Any) -> object:
        with suppress(Exception):
            return await one(bench, call)
        return None

    believes_facts(patch)
    patch.setattr(Bench, "_one", quiet)


FALSE, WRONG, HANG, TWICE = "false success", "wrong cause", "hang", "moves were said"
UNTRUE = ("lie", "short")
BUGS = (
    Bug(driver="dobot", plant=believes_joints, faults=UNTRUE, seeds=range(5), found=FALSE),
    Bug(
        driver="dobot", plant=ends_a_dobot_without_its_number, faults=("late_start",), seeds=[0], found=WRONG
    ),
    Bug(driver="ur", plant=believes_joints, faults=UNTRUE, seeds=range(5), found=FALSE),
    Bug(driver="ur", plant=ends_a_ur_without_its_number, faults=("late_start",), seeds=[0], found=WRONG),
    Bug(driver="gcode-grbl", plant=believes_joints, faults=UNTRUE, seeds=range(3), found=FALSE),
    Bug(driver="gcode-grbl", plant=ends_at_the_ok, faults=("late_start",), seeds=[3], tasks=2, found=WRONG),
    Bug(
        driver="gcode-limp", plant=trusts_a_place_after_a_boot, faults=("boot",), seeds=range(4), found=FALSE
    ),
    Bug(driver="gcode-marlin", plant=hears_no_switch, faults=("endstop_hit",), seeds=range(3), found=FALSE),
    Bug(
        driver="gcode-moonraker", plant=sends_pieces_twice, faults=("noise",), seeds=[3], tasks=2, found=TWICE
    ),
    Bug(driver="serial_arm-feetech", plant=believes_servos, faults=("stall",), tasks=TASKS // 2, found=FALSE),
    Bug(driver="serial_arm-feetech", plant=ends_servos_at_once, faults=("part",), tasks=1, found=""),
    Bug(driver="opcua", plant=believes_facts, faults=("lies", "blind"), seeds=range(3), found=FALSE),
    Bug(driver="modbus", plant=knows_no_numbers, faults=("bad_part",), found=WRONG),
    Bug(driver="modbus", plant=orders_twice, faults=("bad_part",), found=TWICE),
    Bug(driver="navigate_to_pose", plant=believes_bases, faults=("cart.lie",), seeds=range(3), found=FALSE),
    Bug(
        driver="navigate_to_pose",
        plant=believes_before_rest,
        faults=("cart.early",),
        seeds=range(3),
        found=WRONG,
    ),
    Bug(driver="ros2_control", plant=believes_joints, faults=("arm.lie",), seeds=range(3), found=FALSE),
    Bug(driver="ros2_control", plant=believes_grips, faults=("jaw.empty",), found=WRONG),
    Bug(
        driver="ros2_control",
        plant=never_gives_up_a_switch,
        faults=("jaw.stall",),
        seeds=range(4),
        found=HANG,
        marks=[pytest.mark.long],
    ),
    Bug(
        driver="pylabrobot",
        plant=takes_exceptions_for_returns,
        faults=("refuses", "unplugged"),
        seeds=range(6),
        found=FALSE,
        marks=[pytest.mark.requires("pylabrobot")],
    ),
    Bug(driver="vda5050-2.1", plant=says_a_cancel_once, seeds=[DEAF_AND_REFUSED], found=HANG),
    Bug(driver="vda5050-2.1", plant=believes_bases, faults=UNTRUE, seeds=range(5), found=FALSE),
)


@pytest.mark.parametrize(
    "bug", [pytest.param(each, id=f"{each.driver}-{each.plant.__name__}", marks=each.marks) for each in BUGS]
)
def test_a_bug_would_be_found(bug: Bug, monkeypatch: Patch) -> None:
    bug.plant(monkeypatch)
    assert any(
        bug.found in each
        for seed in bug.seeds
        for each in breaches(bug.driver, seed, *bug.faults, tasks=bug.tasks)
    )
