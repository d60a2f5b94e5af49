"""Departure of a plant's messages: first, late, or from a plant that can keep nothing more.

Messages do not leave in the order in which they arose: stops overtake. A command that a stop of its robot has
overtaken must never leave, as it would move what was stopped. `Stop` with CLEAR ends no motion, so it waits
as other commands do: `ends_motion` is the question, not the class.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import NamedTuple

from arboleda.engine import Plant
from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.messages import Heartbeat, LateDeparture, Notice, OperatorAnswer, OperatorRequest, Outcome
from arboleda.model.sentence import Phrase, Sentence

SENT_TOO_LATE = Phrase("command.too_late", "the plant was away for {seconds:.1f} s before it could send this")
OVERTAKEN = Phrase("command.overtaken", "a stop of {robot} left before this could be sent")
STILL_WAITS = Phrase("stop.still_waits", "its disk, its database or something else keeps it waiting")
LEFT_UNKEPT = Phrase(
    "stop.left_unkept",
    "the stop has left for {scope}, and the plant has not kept it ({why}); a restart would not know of it",
)
DONE_UNKEPT = Phrase(
    "act.done_unkept",
    "{verb} {scope} is done, and the plant has not kept it ({why}); a restart would not know of it",
)
TAKEN_UP_LATER = Phrase(
    "act.taken_up_later",
    "{verb} {scope} has reached the plant, which has not done it yet ({why}); look again",
)
WORTH_TELLING_S = 0.02  # a commit takes a few ms
EVERYTHING = Phrase("stop.everything", "the whole plant")
SYNCED_WITHIN_S = 0.01  # from a write to its sync where nobody waits, so that writes of all cells share one
MOST_UNSYNCED_S = 0.1  # a plant with a write that has not been durable for so long sends only stops


class Unkept(OperatorAnswer):
    """Answer to an act that has happened and is not kept, or that the plant has yet to do, as `why` says."""


class StopLeft(Unkept):
    """Answer to a stop that has left for its robots and is not kept, as `why` says."""


class Departure(NamedTuple):
    """Order in which the messages of a step leave: `stops` before the `others`.

    `overtaken` are commands that came before a stop of their robot. They must not leave after it.
    """

    stops: Sequence[Command | Notice]
    others: Sequence[Command | Notice]
    overtaken: Sequence[Command]


def departure(messages: Sequence[Command | Notice]) -> Departure:
    """Parts the messages of a step by when they leave."""
    stops, others, overtaken = list[Command | Notice](), list[Command | Notice](), list[Command]()
    stopped: set[str] = set()
    for message in reversed(messages):
        if not isinstance(message, Command):
            others.append(message)
        elif ends_motion(message):
            stops.append(message)
            stopped.add(message.robot)
        elif message.robot in stopped:
            overtaken.append(message)
        else:
            others.append(message)
    return Departure(stops[::-1], others[::-1], overtaken[::-1])


def stop_left(request: OperatorRequest | OperatorAnswer, why: Sentence) -> StopLeft:
    """Answer to a request for a stop that is not kept because of `why`."""
    unkept = LEFT_UNKEPT(scope=request.scope.strip() or EVERYTHING(), why=why)
    return StopLeft(
        verb=request.verb, scope=request.scope, request=request.request, outcome=Outcome.SENT, why=unkept
    )


def done_unkept(answer: OperatorAnswer, why: Sentence) -> Unkept:
    """Answer to an act that has happened in the plant and is not kept because of `why`."""
    values = {each.name: getattr(answer, each.name) for each in fields(answer)}
    scope = answer.scope.strip() or EVERYTHING()
    return Unkept(**{**values, "why": DONE_UNKEPT(verb=answer.verb.value, scope=scope, why=why)})


def taken_up_later(request: OperatorRequest, why: Sentence) -> Unkept:
    """Answer to a request that the plant has, and that waits in it because of `why`."""
    scope = request.scope.strip() or EVERYTHING()
    waits = TAKEN_UP_LATER(verb=request.verb.value, scope=scope, why=why)
    return Unkept(
        verb=request.verb, scope=request.scope, request=request.request, outcome=Outcome.SENT, why=waits
    )


def done_at_once(messages: Sequence[Command | Notice]) -> list[OperatorAnswer]:
    """Answers of a step to acts that have happened once the stops of the step have left.

    These are the answers before the first command that is no stop: the commands of an act precede its answer.
    """
    answers = list[OperatorAnswer]()
    for message in messages:
        if isinstance(message, Command) and not ends_motion(message):
            break
        if isinstance(message, OperatorAnswer) and _has_happened(message):
            answers.append(message)
    return answers


def _has_happened(answer: OperatorAnswer) -> bool:
    """True for an act that was not refused and awaits an answer; a stop has an answer of its own."""
    return answer.refusal is None and bool(answer.request) and not answer.verb.row.stops


def ends_motion(message: Command | Notice) -> bool:
    """True for a stop: it is never too late, and needs nothing to be kept."""
    return isinstance(message, Stop) and message.mode is not StopMode.CLEAR


def is_too_late(message: Command | Notice, plant: Plant, now: float) -> bool:
    """True for a command of a step that was long ago, as the plant was away since: it may be wrong now."""
    stale = now - plant.now > plant.away_after_s
    return stale and isinstance(message, Command) and not ends_motion(message)


def late_departure(message: Command | Notice, plant: Plant, now: float) -> LateDeparture | None:
    """The event for a late command that counts as done by its time alone; None for any other message."""
    entry = plant.dispatcher.ledger.entries.get(message.id) if isinstance(message, Command) else None
    late_s = now - plant.now
    if entry is None or entry.settles_at is None or late_s < WORTH_TELLING_S:
        return None
    return LateDeparture(at=now, id=entry.command.id, late_s=late_s)


def leaves_unkept(message: Command | Notice) -> bool:
    """True for messages that leave a plant which can keep nothing: stops, and the heartbeat they need."""
    return isinstance(message, Heartbeat) or ends_motion(message)
