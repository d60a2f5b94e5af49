"""Sentences on commands that were refused, and on foreign commands that were carried out."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.model import refusals
from arboleda.model.commands import Command
from arboleda.model.plant_model import Robot
from arboleda.model.sentence import OWN, Phrase, Sentence

from .forms import BEYOND, DEGREES, ELSEWHERE, NODES, ON_THE_GRID, OTHER_UNIT, UNDONE, form_of
from .hop import shown

SOMEBODY = Phrase("foreign.somebody", "another node")
REJECTED = Phrase("rejection", "{robot}: {command} was refused ({word}): {why}")
REJECTED_OF = Phrase("rejection_of", "{robot}: {command} of {sender} was refused ({word}): {why}")
PASSED_OVER = Phrase("rejection.passed_over", "{robot}: its board passes over {command}: {why}")
OBEYED = Phrase("foreign.obeyed", "{robot}: {command} of {sender} was obeyed")
OVERHEARD = Phrase("foreign.overheard", "{robot}: {command} of {sender} was sent to it")
TAKEN = Phrase(
    "foreign.taken",
    "{robot}: its board took a command of another MQTT client (epoca {epoch}, seq {seq})",
)
BEATEN = Phrase(
    "foreign.beaten",
    "{robot}: another bridge has come to its board (epoca {epoch}); what this plant commands next is "
    "numbered above it. End the other one",
)
YIELDED = Phrase(
    "foreign.yielded",
    "{robot}: another bridge was at its board before this one (epoca {epoch} now), which commands it no "
    "more. End the other one and start this one again, or give this plant a broker of its own",
)
WHY = {
    refusals.NO_LINK: Phrase("why.no_link", "its board is not heard"),
    refusals.NO_STOP: Phrase("why.no_stop", "the plant file says that it has no stop"),
    refusals.NO_HOME: Phrase("why.no_home", "it has no homing routine"),
    refusals.OLD_EPOCH: Phrase(
        "why.old_epoch", "it is of another start of the plant than the one that is heard"
    ),
    refusals.OTHER_BRIDGE: Phrase(
        "why.other_bridge",
        "another bridge was at its board before this one; end it, then start this one again",
    ),
    refusals.FOREIGN: Phrase("why.foreign", "a plant commands this robot (foreign_commands: refuse)"),
    refusals.FORMAT: Phrase("why.formato", "it makes no sense for this robot"),
    refusals.LIMIT: Phrase("why.limite", "it is beyond a limit of the robot"),
    refusals.STOPPED: Phrase("why.paro", "its stop is latched"),
    refusals.NOT_HOMED: Phrase("why.sin_ref", "it is not homed"),
    refusals.BUSY: Phrase("why.ocupado", "it is homing"),
    refusals.CONDITION: Phrase("why.condicion", "what this needs to be so is not so"),
    refusals.OLD: Phrase("why.viejo", "its board has taken a later command"),
    refusals.RETAINED: Phrase("why.retenido", "the broker kept it"),
    refusals.LATE: Phrase(
        "why.tarde", "it came too late: who gave it had not heard the board for 2 s by the time it arrived"
    ),
}
"""Meanings of the words with which bridge and boards refuse commands."""


@dataclass(frozen=True, kw_only=True)
class Rejection:
    """Command that the bridge or the board refused.

    `command` is its plain topic, with the value if that is a single number; `id` is "" for a foreign command.
    """

    at: float
    robot: str
    command: str
    id: str
    reason: str
    sentence: Sentence


@dataclass(frozen=True, kw_only=True)
class ForeignCommand:
    """Foreign command that was carried out while a plant commands the robot."""

    at: float
    robot: str
    sentence: Sentence


def refused(robot: Robot, command: Command, word: str, sender: str, *, by_board: bool) -> Sentence:
    """The sentence for a command that was refused with `word`."""
    why = _why(robot, command, word, by_board=by_board)
    if sender:
        return REJECTED_OF(robot=robot.name, command=shown(command), sender=sender, word=word, why=why)
    return REJECTED(robot=robot.name, command=shown(command), word=word, why=why)


def passed_over(robot: Robot, command: Command, why: Sentence) -> Sentence:
    """The sentence for a command that a board silently ignores."""
    return PASSED_OVER(robot=robot.name, command=shown(command), why=why)


def unreadable(robot: Robot, topic: str, why: Sentence) -> Sentence:
    """The sentence for a message on a robot's topic that is no command."""
    return REJECTED(robot=robot.name, command=topic, word=refusals.FORMAT, why=why)


def obeyed(robot: Robot, command: Command, sender: str) -> Sentence:
    """The sentence for a foreign command that was carried out."""
    return OBEYED(robot=robot.name, command=shown(command), sender=sender or SOMEBODY())


def overheard(command: Command, sender: str) -> Sentence:
    """The sentence for a foreign command to a robot that takes commands of all nodes."""
    return OVERHEARD(robot=command.robot, command=shown(command), sender=sender or SOMEBODY())


def taken(robot: Robot, epoch: int, seq: int) -> Sentence:
    """The sentence for a command that the board got from another MQTT client."""
    return TAKEN(robot=robot.name, epoch=epoch, seq=seq)


def beaten(robot: Robot, epoch: int, *, yielded: bool) -> Sentence:
    """The sentence for another bridge that sends heartbeats to the same board."""
    return (YIELDED if yielded else BEATEN)(robot=robot.name, epoch=epoch)


def _why(robot: Robot, command: Command, word: str, *, by_board: bool) -> Sentence | str:
    more = form_of(robot).why(robot, command, word, by_board)
    return more or (WHY[word]() if word in WHY else word)


FOREIGN_PHRASES = {
    phrase.key: phrase
    for phrase in (
        *(
            SOMEBODY,
            REJECTED,
            REJECTED_OF,
            OBEYED,
            OVERHEARD,
            TAKEN,
            BEATEN,
            YIELDED,
            PASSED_OVER,
            ELSEWHERE,
            ON_THE_GRID,
            NODES,
            BEYOND,
            DEGREES,
            OTHER_UNIT,
            UNDONE,
            OWN,
        ),
        *WHY.values(),
    )
}
"""The phrases of a bridge on foreign commands, by key."""
