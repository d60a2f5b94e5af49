"""Commands that were refused, and those of others that were not: what is said of them, and to whom."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.core.commands import Command, FollowPath, MoveJoints
from arboleda.core.model import Arm, Mobile, Robot

from .goals import FLOAT32_SLACK
from .hop import shown

FOREIGN = "foreign"  # the word that refuses a command of another node
SOMEBODY = "another node"
WHY = {
    "no_link": "its board is not heard",
    "no_stop": "the plant file says that it has no stop",
    "old_epoch": "it is of another start of the plant than the one that is heard",
    FOREIGN: "a plant commands this robot (foreign_commands: refuse)",
    "formato": "it makes no sense for this robot",
    "limite": "it is beyond a limit of the robot",
    "paro": "its stop is latched",
    "sin_ref": "it is not homed",
    "ocupado": "it is homing",
    "viejo": "its board has taken a later command",
    "retenido": "the broker kept it",
}
"""What the words of bridge and boards mean."""


@dataclass(frozen=True, kw_only=True)
class Rejection:
    """A command that was refused, by the bridge or by the board.

    `command` is the plain topic and, where it is one number, the value; `id` is "" where it had none.
    """

    at: float
    robot: str
    command: str
    id: str
    reason: str
    sentence: str


@dataclass(frozen=True, kw_only=True)
class ForeignCommand:
    """A command of somebody else that was carried out while a plant commands the robot."""

    at: float
    robot: str
    sentence: str


def refused(robot: Robot, command: Command, word: str, sender: str, *, by_board: bool) -> str:
    """The sentence for a command that was refused with a word."""
    of = f" of {sender}" if sender else ""
    why = _why(robot, command, word, by_board=by_board)
    return f"{robot.name}: {shown(command)}{of} was refused ({word}): {why}"


def obeyed(robot: Robot, command: Command, sender: str) -> str:
    """The sentence for a command of somebody else that was carried out."""
    return f"{robot.name}: {shown(command)} of {sender or SOMEBODY} was obeyed"


def overheard(command: Command, sender: str) -> str:
    """The sentence for a command of somebody else to a robot that hears everybody."""
    return f"{command.robot}: {shown(command)} of {sender or SOMEBODY} was sent to it"


def taken(robot: Robot, epoch: int, seq: int) -> str:
    """The sentence for a command that the board has from nobody but another MQTT client."""
    return f"{robot.name}: its board took a command of another MQTT client (epoca {epoch}, seq {seq})"


def _why(robot: Robot, command: Command, word: str, *, by_board: bool) -> str:
    if word == "limite" and isinstance(command, MoveJoints) and isinstance(robot, Arm):
        return _beyond(robot, command) or WHY[word]
    if word == "limite" and isinstance(command, FollowPath) and isinstance(robot, Mobile):
        if by_board:
            return "a path begins at the robot's node or next to it, and follows the grid"
        return f"its nodes are 0 to {robot.grid.size - 1}"
    return WHY.get(word, word)


def _beyond(arm: Arm, command: MoveJoints) -> str:
    """The first joint beyond its limits; "" where none is."""
    for number, (joint, value) in enumerate(zip(arm.joints, command.q, strict=True), start=1):
        if not joint.lower - FLOAT32_SLACK <= value <= joint.upper + FLOAT32_SLACK:
            allowed = f"{joint.lower:.4g} to {joint.upper:.4g} {joint.unit}"
            return f"number {number} is {value:.4g}; allowed: {allowed}"
    return ""
