"""Drivers; with `@driver`, a class with `start`, `send` and `stop` makes a driver of your own."""

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.declared import VerbCall as VerbCommand
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import MotionState, Receipt, Report, Tokens
from arboleda.model.plant_model import Robot

from .port import Clock, Driver, DriverError, Hear, NotSent, driver, lost

__all__ = [
    "Clock",
    "Command",
    "Driver",
    "DriverError",
    "FollowPath",
    "Hear",
    "Home",
    "MotionState",
    "MoveJoints",
    "NotSent",
    "Receipt",
    "Report",
    "Robot",
    "SetEffector",
    "Stop",
    "StopMode",
    "Tokens",
    "VerbCommand",
    "driver",
    "lost",
]
