"""Health of a robot as its hardware publishes it beside the action, and the calls that clear a stop."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import HEALTH, WELL, Value, plain

READY_S = 15.0  # a robot that releases its brakes takes some seconds
LONGEST_WORD = 80


@dataclass(frozen=True, kw_only=True)
class Call:
    """Settings of a call that leads out of a stop: the name of a service or of an action, and its type.

    `request` has fields of the request, or of the goal, that are not as the type has them.
    """

    type: str
    service: str = ""
    action: str = ""
    request: dict[str, Value] = dataclasses.field(default_factory=dict)

    def __post_init__(self) -> None:
        if bool(self.service) == bool(self.action):
            raise ValueError("give either a service or an action")
        if self.type.split("/")[1:-1] != ["srv" if self.service else "action"]:
            form = "std_srvs/srv/Trigger" if self.service else "franka_msgs/action/ErrorRecovery"
            raise ValueError(f"type is {self.type}; it is written as {form}")

    @property
    def name(self) -> str:
        """The name of the service or action."""
        return self.service or self.action


@dataclass(frozen=True, kw_only=True)
class Health:
    """Settings of a robot's health: a topic, a field of its messages, and the values with which it can move.

    `words` names the other values. `clear` are the calls that lead out of a stop, in their order.
    """

    topic: str
    type: str
    field: str
    well: tuple[Value, ...]
    words: dict[str, Value] = dataclasses.field(default_factory=dict)
    clear: tuple[Call, ...] = ()

    def __post_init__(self) -> None:
        if self.type.split("/")[1:-1] != ["msg"]:
            raise ValueError(f"type is {self.type}; it is written as std_msgs/msg/Int32")
        if not self.well:
            raise ValueError("well is empty; it lists the values with which the robot can move")
        if WELL in self.words:
            raise ValueError(f'"{WELL}" is the word for the values under well; give another one')

    def word(self, value: Value) -> str:
        """The word for a value of the field: WELL where the robot can move with it."""
        if value in self.well:
            return WELL
        named = (word for word, known in self.words.items() if known == value)
        return next(named, plain(f"{self.field} {value}", LONGEST_WORD))


@dataclass(frozen=True, kw_only=True)
class HealthReading:
    """Event: the value of the field in a message of the topic."""

    value: Value


@dataclass(frozen=True, kw_only=True)
class CallAnswer:
    """Event: a call was answered; `ok`: it was carried out, as far as the answer tells."""

    call: Call
    ok: bool
    text: str = ""


class HealthWatch:
    """Watch over a robot's health, and its way out of a stop, call by call.

    An answer to a call proves nothing: the robot is out of the stop once its topic shows that. A robot
    without settings for it counts as well.
    """

    def __init__(self, settings: Health | None) -> None:
        self._settings = settings
        self._word = "" if settings is not None else WELL
        self._next = 0  # index of the call that is waited for, or the number of calls
        self._until = math.inf

    @property
    def word(self) -> str:
        """The word for what keeps the robot from moving; WELL for nothing."""
        return self._word

    @property
    def is_well(self) -> bool:
        return self._word == WELL

    @property
    def can_clear(self) -> bool:
        return self._settings is not None and self._settings.clear != ()

    @property
    def shows(self) -> dict[str, Any]:
        """The fields of a report that hold its health; none for a robot whose health is not watched."""
        return {} if self._settings is None else {"facts": ((HEALTH, self._word),)}

    @property
    def missing(self) -> str:
        """The reason why its health is unknown; "" if it is known."""
        return "" if self._word or self._settings is None else f"{self._settings.topic} has said nothing yet"

    def see(self, value: Value) -> bool:
        """Take a value of the topic; True if the word for it is another one than before."""
        assert self._settings is not None
        before, self._word = self._word, self._settings.word(value)
        return self._word != before

    def clear(self, now: float) -> Call:
        """Begin to lead the robot out of its stop: the first call."""
        self._next, self._until = 0, now + READY_S
        return self._calls[0]

    def answered(self, now: float, answer: CallAnswer) -> Call | str | None:
        """The next call, or the reason for which there is none; None where the last one was answered."""
        if self._next >= len(self._calls) or answer.call != self._calls[self._next]:
            return None
        if not answer.ok:
            return f"{answer.call.name} {answer.text}".strip()
        self._next, self._until = self._next + 1, now + READY_S
        return self._calls[self._next] if self._next < len(self._calls) else None

    def overdue(self, now: float) -> str:
        """The reason why the robot is not out of its stop in time; "" while it may still come."""
        if now < self._until:
            return ""
        if self._next < len(self._calls):
            return f"{self._calls[self._next].name} not_answered"
        return f"still {self._word}"

    @property
    def _calls(self) -> tuple[Call, ...]:
        return () if self._settings is None else self._settings.clear
