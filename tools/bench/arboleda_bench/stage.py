"""Robots in this process, others that command them, and tasks given on demand over ROS 2."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Protocol

from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import String, UInt32

from arboleda.extension import ArboledaError
from arboleda.model.plant_model import Cell
from arboleda_ros import qos
from arboleda_ros.link import connect

from . import steps
from .moments import Moment
from .processes import Process
from .scene import wait_for

READY_S, CYCLE_S = 20.0, 10.0
OURS = 0  # the cell that Arboleda runs; all others belong to whatever it is compared with


class Robots(Protocol):
    """Robots of whatever kind; `missing` names what they still wait for."""

    @property
    def moments(self) -> Mapping[str, Sequence[Moment]]: ...
    @property
    def missing(self) -> Sequence[str]: ...
    def start(self) -> None: ...
    def stop(self) -> None: ...


class Stage:
    """Robots that `make` makes, commanded by `others`, between `with`; cell OURS is asked as users ask."""

    def __init__(
        self, cells: Sequence[Cell], make: Callable[[Node], Robots], others: Sequence[Process]
    ) -> None:
        self.cells = cells
        self._others = others
        self._link = connect()
        self.node = self._link.node("robots")
        self.robots = make(self.node)
        self._beats = 0
        self._failed: list[str] = []
        self.node.create_subscription(String, "task_status", self._on_status, qos.TASK_STATUS)
        self.node.create_subscription(UInt32, "plant/heartbeat", self._on_beat, qos.COMMAND)
        self._ask = {cell.name: self._asking(number, cell) for number, cell in enumerate(cells)}

    def __enter__(self) -> Stage:
        try:
            self._link.start()
            self.robots.start()
            wait_for(self._ready, "what commands the robots", self.check, READY_S)
        except BaseException:  # Ctrl-C too
            self.close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the robots and leave ROS 2."""
        self.robots.stop()
        self._link.close()

    def check(self) -> None:
        """Raise ArboledaError if one of the others has ended, or a task was not done."""
        for process in self._others:
            process.check()
        for sentence in self._failed:
            raise ArboledaError(f"a task of the benchmark was not done: {sentence}")

    def play(self, cycles: int, *cells: Cell) -> None:
        """Have each of the cells carry out so many storage tasks, and wait for their end."""
        wanted = {cell.name: self.played(cell) + cycles for cell in cells}
        for cell in cells:
            for _ in range(cycles):
                self._ask[cell.name].publish(String(data=steps.task(cell)))
        for cell in cells:
            what = f"the end of {cycles} tasks in cell {cell.name}"
            wait_for(partial(self._has_played, cell, wanted[cell.name]), what, self.check, cycles * CYCLE_S)

    def _has_played(self, cell: Cell, tasks: int) -> bool:
        return self.played(cell) >= tasks

    def played(self, cell: Cell) -> int:
        """The number of tasks that the cell has ended."""
        return sum(moment.last for moment in self.moments(cell))

    def moments(self, cell: Cell) -> list[Moment]:
        """The moments in a cell so far."""
        return list(self.robots.moments[cell.name])

    def _asking(self, number: int, cell: Cell) -> Publisher:
        topic = "task_request" if number == OURS else f"{cell.name}/task_request"
        return self.node.create_publisher(String, topic, qos.COMMAND)

    def _ready(self) -> bool:
        deaf = [each for each in self._ask.values() if not each.get_subscription_count()]
        return bool(self._beats) and not deaf and not self.robots.missing

    def _on_status(self, message: String) -> None:
        change = json.loads(message.data)
        if change["state"] in ("failed", "cancelled", "refused"):
            self._failed.append(change["sentence"])

    def _on_beat(self, _: UInt32) -> None:
        self._beats += 1
