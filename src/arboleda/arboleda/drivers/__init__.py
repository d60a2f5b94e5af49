"""Drivers; with `@driver`, a class with `start`, `send` and `stop` makes a driver of your own.

Here is also what a driver is about: robots and devices, their facts, verbs, commands and reports, and
functions that put into a sentence what a controller has said.
"""

from arboleda.kinds.arm import Arm, SetEffector
from arboleda.kinds.declared import (
    Device,
    DeviceKind,
    DeviceVerb,
    Effect,
    FactType,
    Slot,
    UseError,
    makes_parts,
)
from arboleda.kinds.declared import VerbCall as VerbCommand
from arboleda.kinds.joints import Joint, Jointed, MoveJoints
from arboleda.kinds.mobile import FollowPath, Grid, Mobile
from arboleda.model.commands import (
    Command,
    Home,
    Motion,
    OnStop,
    Position,
    Process,
    Query,
    Stop,
    StopMode,
    Switch,
    Work,
    needs_clear,
)
from arboleda.model.errors import ArboledaError, PayloadError
from arboleda.model.facts import HEALTH, WELL, Facts, Value, shown
from arboleda.model.messages import MotionState, Receipt, Report, Tokens
from arboleda.model.outside import among, plain, quoted, text_of_error
from arboleda.model.plant_model import Evidence, Robot

from .port import Clock, Driver, DriverError, Hear, NotSent, driver, lost

__all__ = [
    "HEALTH",
    "WELL",
    "ArboledaError",
    "Arm",
    "Clock",
    "Command",
    "Device",
    "DeviceKind",
    "DeviceVerb",
    "Driver",
    "DriverError",
    "Effect",
    "Evidence",
    "FactType",
    "Facts",
    "FollowPath",
    "Grid",
    "Hear",
    "Home",
    "Joint",
    "Jointed",
    "Mobile",
    "Motion",
    "MotionState",
    "MoveJoints",
    "NotSent",
    "OnStop",
    "PayloadError",
    "Position",
    "Process",
    "Query",
    "Receipt",
    "Report",
    "Robot",
    "SetEffector",
    "Slot",
    "Stop",
    "StopMode",
    "Switch",
    "Tokens",
    "UseError",
    "Value",
    "VerbCommand",
    "Work",
    "among",
    "driver",
    "lost",
    "makes_parts",
    "needs_clear",
    "plain",
    "quoted",
    "shown",
    "text_of_error",
]
