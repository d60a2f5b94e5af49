"""Topics `plant/tasks` and `{cell}/state`: parts of the view, published when they change."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from arboleda_interfaces.msg import CellState, TaskList
from rclpy.node import Node
from rclpy.publisher import Publisher

from arboleda_ros import qos

from . import values

Speak = Callable[..., Publisher]


class Topics:
    """Publishers; call `show` with each snapshot, from one thread."""

    def __init__(self, node: Node, speak: Speak, cells: Iterable[str]) -> None:
        self._node = node
        self._tasks = speak(TaskList, "plant/tasks", qos.VIEW)
        self._cells = {cell: speak(CellState, f"{cell}/state", qos.VIEW) for cell in cells}
        self._last: dict[Publisher, Any] = {}

    def show(self, view: Mapping[str, Any]) -> None:
        """Publish the parts that have changed."""
        tasks = [{**task, "elapsed_s": None} for task in view["tasks"]]
        self._publish(self._tasks, tasks, _task_list)
        for cell in view["cells"]:
            self._publish(self._cells[cell["name"]], _cell(cell), lambda plain: CellState(**plain))

    def _publish(self, publisher: Publisher, plain: Any, message_of: Callable[[Any], Any]) -> None:
        if self._last.get(publisher) == plain:
            return
        self._last[publisher] = plain
        message = message_of(plain)
        message.stamp = self._node.get_clock().now().to_msg()
        publisher.publish(message)


def _task_list(tasks: list[dict[str, Any]]) -> TaskList:
    return TaskList(tasks=[values.task_message(task) for task in tasks])


def _cell(cell: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "cell": cell["name"],
        "state": cell["state"],
        "task": cell["task"]["id"] if cell["task"] else "",
        "step": str(cell["step"] or ""),
        "progress": cell["progress"] or 0.0,
        "queue_running": not cell["paused"],
        "queue": cell["queue"],
        "waiting_for": str(cell["not_ready"] or cell["waiting_for"] or ""),
    }
