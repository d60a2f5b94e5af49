"""Plan of a launch: made from its arguments, the plant file and the robots' descriptions."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import partial
from pathlib import Path

from arboleda.plant_file.loader import load
from arboleda.plant_file.urdf import robot_urdf
from arboleda_ros.link import limit_discovery

from .choice import read
from .row import Plan
from .table import table


def plan(texts: Mapping[str, str], share: str) -> Plan:
    """The plan for these launch arguments; ArboledaError if they or the plant file are wrong.

    All nodes of the launch must be on the same network, so they get what limits them to this machine.
    """
    choice = read(texts)
    plant = load(Path(choice.plant) if choice.plant else None)
    rows = table(plant, choice, urdf=partial(robot_urdf, plant), share=share)
    limited = dict(os.environ)
    note = limit_discovery(limited, lan=False)
    added = {name: value for name, value in limited.items() if name not in os.environ}
    return Plan(rows=rows, environment=added, notes=[note] if note else [])
