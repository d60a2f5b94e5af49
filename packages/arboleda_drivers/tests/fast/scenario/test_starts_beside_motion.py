"""A plant that was killed and starts again halts the robots that still move; time is moved by hand."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from arboleda.model.messages import MotionState
from arboleda.plant_file.loader import load
from arboleda.testing.plants import shipped
from arboleda.views import view
from arboleda_driver_faults.dobot import DobotRig
from arboleda_driver_faults.gcode import GantryRig, MarlinRig, MoonrakerRig
from arboleda_driver_faults.gripper import CarryRig
from arboleda_driver_faults.nav2 import RoundRig, WaypointsRig
from arboleda_driver_faults.rig import Result, Rig, World
from arboleda_driver_faults.serial_arm import ServoRig
from arboleda_driver_faults.ur import UrRig
from arboleda_driver_faults.vda5050 import AgvRig

EXAMPLES = Path(__file__).parents[5] / "examples"
SLOW = {
    "follow_joint_trajectory": "arm.slow",
    "navigate_to_pose": "cart.slow",
    "follow_waypoints": "cart.slow",
}
HALTS_S = 4.5  # Klipper's queue is given 3.5 s to end before it is shut down
ROBOTS: dict[str, Callable[[], Rig]] = {
    "dobot": lambda: DobotRig(shipped()),
    "ur": lambda: UrRig(shipped()),
    "serial_arm-feetech": lambda: ServoRig(load(EXAMPLES / "serial_arm/desk.yaml")),
    "serial_arm-dynamixel": lambda: ServoRig(load(EXAMPLES / "serial_arm/desk.yaml"), "dynamixel"),
    "gcode-grbl": lambda: GantryRig(load(EXAMPLES / "gantry/bench.yaml")),
    "gcode-marlin": lambda: MarlinRig(load(EXAMPLES / "gantry/marlin.yaml")),
    "gcode-moonraker": lambda: MoonrakerRig(load(EXAMPLES / "gantry/moonraker.yaml")),
    "follow_joint_trajectory": lambda: CarryRig(load(EXAMPLES / "ros2_control/plant.yaml")),
    "navigate_to_pose": lambda: RoundRig(load(EXAMPLES / "nav2/plant.yaml")),
    "follow_waypoints": lambda: WaypointsRig(load(EXAMPLES / "nav2/plant.yaml")),
    "vda5050": lambda: AgvRig(load(EXAMPLES / "agv/plant.yaml")),
}


class SlowMove(World):
    """A world whose robot is in the middle of a move, at a tenth of its speed."""

    def __init__(self, name: str) -> None:
        super().__init__(ROBOTS[name](), Result(seed=0, faults=()), tasks=1)
        self._is_killed = False
        self.advance(30.0, until=lambda: not self.plant.advice(self._cell.name))
        self.rig.faults.switch(SLOW.get(name, "slow"), on=True)
        self.submit(self.rig.task(0))
        at_rest = self.rig.where
        assert self.advance(30.0, until=lambda: self.rig.where != at_rest)
        self.advance(0.5)
        assert self.moves(0.2)

    def moves(self, seconds: float) -> bool:
        """True where the robot is elsewhere after so much time."""
        before = self.rig.where
        self.advance(seconds)
        return self.rig.where != before

    def kill(self) -> None:
        self._is_killed = True
        self.restart()

    @property
    def told(self) -> str:
        """What screens say of the cell."""
        (cell,) = view.snapshot(self.plant)["cells"]
        return str(cell["held_by"])

    @property
    def state(self) -> MotionState | None:
        """The state of the robot, as far as this start of the plant knows."""
        rows = {row["name"]: row["state"] for row in view.snapshot(self.plant)["robots"]}
        found = rows[self.rig.robots[0].name]
        return None if found is None else MotionState(found)

    def _attend(self) -> None:
        if not self._is_killed:
            super()._attend()


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_robot_that_moves_as_a_plant_starts_is_halted(robot: str) -> None:
    world = SlowMove(robot)
    world.kill()
    world.advance(HALTS_S)
    assert not world.moves(2.0)


@pytest.mark.parametrize("robot", ROBOTS)
def test_nobody_is_told_that_a_robot_stands_which_moves(robot: str) -> None:
    world = SlowMove(robot)
    world.kill()
    told: list[tuple[str, MotionState | None]] = []
    said = (world.told, world.state)
    while world.moves(0.02):
        told.append(said)
        said = (world.told, world.state)
    assert told, "it moved for a while"
    assert not any("stands" in words for words, _ in told)
    assert {state for _, state in told} <= {None, MotionState.MOVING, MotionState.NO_LINK}
