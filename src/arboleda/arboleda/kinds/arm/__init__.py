"""Arm: a robot of joints with an effector, a place on the floor and a model."""

from .commands import SetEffector
from .robot import Arm

__all__ = ["Arm", "SetEffector"]
