"""Pose of one robot at one target of a cell of devices."""

from __future__ import annotations

from typing import cast

from arboleda.kinds.joints import Jointed
from arboleda.model.plant_model import Pose, Robot
from arboleda.model.sentence import OWN

from .document import Document, Place
from .poses import PoseReader
from .shapes import NodeShape

START = "home"  # the target where each robot waits


def target_pose(document: Document, place: Place, robot: Robot, name: str) -> Pose | None:
    """The pose of the robot that the file has there for a target; None, with the problem kept, if wrong."""
    if robot.floor_grid:
        shape = document.read(NodeShape, place)
        if shape is not None and shape.node >= robot.floor_grid.size:
            document.problem((*place, "node"), f"must be 0 to {robot.floor_grid.size - 1}, is {shape.node}")
            return None
        return None if shape is None else Pose(name=name, title=OWN(text=name), q=shape.node)
    assert robot.joints
    model = cast(Jointed, robot).model or robot.kind_name
    reader = PoseReader(document=document, cell=str(place[1]), model=model, joints=robot.joints)
    return reader.home(place) if name == START else reader.pose(place, OWN(text=name))
