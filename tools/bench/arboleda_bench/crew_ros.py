"""Crew on ROS 2: played robots behind the topics of the shipped bridge, and a user who asks for tasks."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from itertools import count
from pathlib import Path
from typing import Any

from arboleda.extension import ArboledaError, StartError
from arboleda.plant_file.loader import load

from .played import Crew
from .processes import Process
from .scene import wait_for

NEEDS = "this benchmark needs ROS 2 for Python: pip install arboleda[ros], or source a ROS 2 installation"
DISCOVERY_S = 30.0
WORK_S = 30.0  # until every cell of a plant has begun a task
DEPTH = 1000  # of the user's publisher: DDS forgets what it cannot send as fast as it is asked
HEARD = 10_000  # lines of /task_status that may wait to be read


class CrewOnRos:
    """The robots of a plant file in this process, and a user; made before the plant's node answers.

    `changes` are the messages on /task_status, in order.
    """

    def __init__(self, plant: Path, *, move_s: float = 1.0) -> None:
        try:
            from rclpy.qos import DurabilityPolicy, QoSProfile
            from std_msgs.msg import String

            from arboleda_ros.link import connect
        except ImportError as error:
            raise StartError(NEEDS) from error
        model = load(plant)
        self.cells = [cell.name for cell in model.cells]
        self.changes: list[dict[str, Any]] = []
        self._text = String
        self._link = connect()
        self._plant_is_there = False
        self._busy = False
        self._number = count()
        self._port = self._link.bridge(model, self._on_message, time.monotonic)
        self.crew = Crew(model, self._port.send, move_s=move_s)
        user = self._link.node("user")
        self._tasks = user.create_publisher(String, "task_request", DEPTH)
        deep = QoSProfile(depth=HEARD, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        user.create_subscription(String, "task_status", self._on_status, deep)
        self._node = user

    def __enter__(self) -> CrewOnRos:
        self._link.start()
        self.crew.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.crew.stop()
        self._link.close()

    def wait_for_the_plant(self, node: Process) -> None:
        """Wait until the plant hears this process, and all its robots."""
        wait_for(lambda: self._plant_is_there, "the orchestrator", node.check, DISCOVERY_S)
        wait_for(lambda: self._tasks.get_subscription_count(), "task_request", node.check, DISCOVERY_S)
        wait_for(lambda: self._node.count_publishers("task_status"), "task_status", node.check, DISCOVERY_S)

    def fall_silent(self) -> None:
        """Have the robots report nothing any more."""
        self.crew.stop()

    def ask(self, text: str) -> None:
        self._tasks.publish(self._text(data=text))

    def keep_busy(self) -> None:
        """Ask for a task of every cell, and for its next one whenever one begins."""
        self._busy = True
        for cell in self.cells:
            self._ask_cell(cell)

    def wait_for_work(self) -> None:
        """Wait until every cell has begun a task."""
        wait_for(lambda: not self._idle(), self._of_idle, limit_s=WORK_S)

    def reactions_in(self, seconds: float) -> Sequence[float]:
        """The reactions of so many seconds, once every cell works; ArboledaError if a task fails."""
        self.wait_for_work()
        self.crew.reactions.clear()
        time.sleep(seconds)
        found = list(self.crew.reactions)
        bad = [each for each in self.changes if each["state"] not in ("queued", "running", "done")]
        if bad or not found:
            raise ArboledaError(f"a task did not end well: {bad[0] if bad else 'none moved'}")
        return found

    def _idle(self) -> list[str]:
        """The cells that have not begun a task yet."""
        begun = {each["cell"] for each in self.changes if each["state"] == "running"}
        return [cell for cell in self.cells if cell not in begun]

    def _of_idle(self) -> str:
        """The first idle cell and the last news of its tasks, for people."""
        cell, *others = self._idle()
        news = [each for each in self.changes if each["cell"] in (cell, None)]
        last = f"{news[-1]['text']}: {news[-1]['state']}, {news[-1]['sentence']}" if news else "no news"
        return f"cell {cell} ({last}), and {len(others)} more," if others else f"cell {cell} ({last})"

    def _ask_cell(self, cell: str) -> None:
        self.ask(f"{cell} 0B {next(self._number) % 9}")

    def _on_message(self, event: Any) -> None:
        self._plant_is_there = True
        self.crew.send(event.message)

    def _on_status(self, message: Any) -> None:
        change = json.loads(message.data)
        self.changes.append(change)
        if self._busy and change["state"] == "running":
            self._ask_cell(change["cell"])
