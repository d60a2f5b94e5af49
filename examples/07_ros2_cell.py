"""Lesson 7: a tree of our own on real ROS 2 topics, with the bridge and the virtual robots of Arboleda."""

from __future__ import annotations

import math
import time
from argparse import ArgumentParser
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence

from arboleda.cli.session import NO_ROS, ros_link
from arboleda.extension import load
from arboleda.runtime.build import Options, build
from arboleda_class.lessons import spoken

try:
    from rclpy.context import Context
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node
    from std_msgs.msg import Float32MultiArray, UInt8
except ImportError:
    raise SystemExit(NO_ROS) from None

PLANT = Path(__file__).parent / "plants" / "lessons.yaml"
ROBOTS = ("rm_sis_a", "ra1")
STATES = {
    0: "stands still",
    1: "moves",
    2: "has a fault",
    3: "is not homed",
    4: "is stopped",
    255: "is not there",
}
STILL, MOVING = 0, 1
PATIENCE_S = 20.0


class Cell(Node):
    """What we say to the robots of sis_a, and what they say."""

    def __init__(self, context: Context) -> None:
        super().__init__("lesson", context=context)
        self.states: dict[str, int] = {}
        for robot in ROBOTS:
            self.create_subscription(UInt8, f"/{robot}/motion_state", self._hearer(robot), 10)
        self.path = self.create_publisher(Float32MultiArray, "/rm_sis_a/path_cmd", 10)
        self.goal = self.create_publisher(Float32MultiArray, "/ra1/joint_goals_q", 10)
        self.effector = self.create_publisher(UInt8, "/ra1/effector_cmd", 10)

    @property
    def ready(self) -> bool:
        """Whether both robots spoke, and each of our topics has a listener."""
        publishers = (self.path, self.goal, self.effector)
        return len(self.states) == 2 and all(each.get_subscription_count() for each in publishers)

    def _hearer(self, robot: str) -> Callable[[Any], None]:
        def hear(message: Any) -> None:
            if self.states.get(robot) != message.data:
                print(f"  {robot} {STATES[message.data]}", flush=True)
            self.states[robot] = message.data

        return hear


class Move(Behaviour):
    """Publish a goal; SUCCESS when the robot was seen moving and then still, FAILURE after PATIENCE_S."""

    def __init__(self, name: str, cell: Cell, robot: str, publish: Callable[[], None]) -> None:
        super().__init__(name)
        self.cell = cell
        self.robot = robot
        self.publish = publish

    def initialise(self) -> None:
        print(self.name, flush=True)
        self.moved, self.until = False, time.monotonic() + PATIENCE_S
        self.publish()

    def update(self) -> Status:
        state = self.cell.states[self.robot]
        self.moved = self.moved or state == MOVING
        if self.moved and state == STILL:
            return Status.SUCCESS
        return Status.RUNNING if time.monotonic() < self.until else Status.FAILURE


class Switch(Behaviour):
    """Publish once; the topic has no answer, so this leaf proves nothing."""

    def __init__(self, cell: Cell, on: bool) -> None:
        super().__init__(f"effector {'on' if on else 'off'}")
        self.cell = cell
        self.message = UInt8(data=int(on))

    def update(self) -> Status:
        print(self.name, flush=True)
        self.cell.effector.publish(self.message)
        return Status.SUCCESS


def cycle(cell: Cell) -> Behaviour:
    """The cycle of lesson 2; angles in rad, as everywhere on ROS 2."""

    def drive() -> None:
        cell.path.publish(Float32MultiArray(data=[0.0, 3.0, 4.0, 7.0]))

    def go(q1: float, q2: float) -> Callable[[], None]:
        return lambda: cell.goal.publish(Float32MultiArray(data=[math.radians(q1), math.radians(q2), 0.0]))

    children = [
        Move("drive path 0B", cell, "rm_sis_a", drive),
        Move("move to pick-up", cell, "ra1", go(45, 10)),
        Switch(cell, True),
        Move("move to station 7", cell, "ra1", go(10, 20)),
        Switch(cell, False),
        Move("move home", cell, "ra1", go(0, 0)),
    ]
    return Sequence("cycle", memory=True, children=children)


def run(context: Context, cell: Cell, *, stay: bool) -> Status:
    """Spin, and tick the tree after every message; with `stay` only spin."""
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(cell)
    while not cell.ready:
        executor.spin_once(timeout_sec=0.1)
    print("The robots are there." + (" Drive them by hand; Ctrl-C ends." if stay else ""), flush=True)
    tree = cycle(cell)
    while stay or tree.status in (Status.INVALID, Status.RUNNING):
        if not stay:
            tree.tick_once()
        executor.spin_once(timeout_sec=0.1)
    executor.shutdown()
    print(f"The cycle says {tree.status.value}.")
    return tree.status


def main() -> None:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("--stay", action="store_true", help="only start the robots, to drive them by hand")
    stay = parser.parse_args().stay
    plant = load(PLANT)
    one_cell = replace(plant, cells=plant.cells[:1])
    app = build(one_cell, {"broker", "bridge", "devices"}, Options(link=ros_link(lan=False)))
    app.start()
    context = Context()
    context.init()
    cell = Cell(context)
    try:
        outcome = run(context, cell, stay=stay)
    except KeyboardInterrupt:
        outcome = Status.SUCCESS
    finally:
        cell.destroy_node()
        context.try_shutdown()
        app.stop()
    raise SystemExit(0 if outcome is Status.SUCCESS else 1)


if __name__ == "__main__":
    spoken(main)
