"""All services, actions and topics of the orchestrator in the types of arboleda_interfaces, as one object."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from rclpy.node import Node

from arboleda.model.messages import TaskChanged
from arboleda_ros.plant_queries import Asker

from .execute_task import ExecuteTaskAction
from .services import Services
from .topics import Speak, Topics


class Offer:
    """Services, actions and topics together, told the news by the plant's thread; ends like a port."""

    def __init__(self, node: Node, speak: Speak, cells: Iterable[str], asker: Asker) -> None:
        self._action = ExecuteTaskAction(node, asker)
        self._services = Services(node, asker)
        self._topics = Topics(node, speak, cells)

    def changed(self, change: TaskChanged) -> None:
        self._action.changed(change)

    def show(self, view: Mapping[str, Any]) -> None:
        self._topics.show(view)
        self._action.show(view)

    def close(self) -> None:
        self._action.close()

    def destroy(self) -> None:
        self._action.destroy()
