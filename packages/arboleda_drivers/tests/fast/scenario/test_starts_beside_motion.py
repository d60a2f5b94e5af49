"""A plant that was killed and starts again halts the robots that still move; time is moved by hand."""

from __future__ import annotations

import pytest

from arboleda.model.messages import MotionState
from arboleda.views import view
from arboleda_driver_faults.rig import Result, World
from arboleda_driver_faults.rigs import RIGS, rig_of

SLOW = {"ros2_control": "arm.slow", "navigate_to_pose": "cart.slow", "follow_waypoints": "cart.slow"}
STILL = (
    "modbus",
    "opcua",
    "s7",
    "pylabrobot",
    "pylabrobot-side_by_side",
)  # they move no robot
ALIKE = ("gcode-limp", "vda5050-2.0", "vda5050-3.0")
ROBOTS = [name for name in RIGS if name not in (*STILL, *ALIKE)]
HALTS_S = 4.5  # Klipper's queue is given 3.5 s to end before it is shut down


class SlowMove(World):
    """A world whose robot is in the middle of a move, at a tenth of its speed."""

    def __init__(self, name: str) -> None:
        super().__init__(rig_of(name), Result(seed=0, faults=()), tasks=1)
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
        """The sentence of screens on the cell."""
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
