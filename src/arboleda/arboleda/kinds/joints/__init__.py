"""Joints: robots whose position is a number for each of their joints."""

from .commands import MoveJoints
from .joint import Joint
from .robot import Description, Jointed

__all__ = ["Description", "Joint", "Jointed", "MoveJoints"]
