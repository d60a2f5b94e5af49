"""Common part of the benchmarks' own nodes: one cell's topics, and an end together with their parent."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import String

from arboleda.drivers import Command
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.plant_file.loader import load
from arboleda.wire.hop import PLAIN
from arboleda_ros import convert, qos
from arboleda_ros.link import connect


def stand(name: str, make: Callable[[Node, PlantModel, Cell], object]) -> None:
    """Run a node for the cell that the command line names, in Arboleda's executor, until the input ends."""
    file, cell = sys.argv[1:3]
    model = load(Path(file))
    link = connect()
    made = make(link.node(f"{name}_{cell}"), model, model.cell(cell))
    link.start()
    try:
        sys.stdin.read()
    except KeyboardInterrupt:
        pass
    finally:
        link.close()
    del made


def voices(node: Node, cell: Cell) -> dict[tuple[str, type[Command]], Publisher]:
    """The publishers for all commands to the cell's robots."""
    return {
        (robot.name, kind): node.create_publisher(
            convert.message_type(kind), f"{robot.name}/{PLAIN[kind]}", qos.COMMAND
        )
        for robot in cell.robots
        for kind in convert.commands_of(robot)
    }


def on_task(node: Node, cell: Cell, begin: Callable[[], None]) -> None:
    """Call `begin` at each task for the cell."""
    node.create_subscription(String, f"{cell.name}/task_request", _ignoring(begin), qos.COMMAND)


def _ignoring(act: Callable[[], None]) -> Callable[[Any], None]:
    return lambda _: act()
