"""Assistants: what a plant file allows to language models that speak with the plant, and its limits."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum

DAY_MIN = 24 * 60
HOURS = re.compile(r"([01]\d|2[0-3]):([0-5]\d)-([01]\d|2[0-4]):([0-5]\d)", re.ASCII)


class Assistants(str, Enum):
    """Levels of rights: nothing, look and stop, propose, give approved tasks; each with those before."""

    OFF = "off"
    READ = "read"
    PROPOSE = "propose"
    SUBMIT = "submit"

    @property
    def may_propose(self) -> bool:
        return self in (Assistants.PROPOSE, Assistants.SUBMIT)


@dataclass(frozen=True, kw_only=True)
class Hours:
    """Hours of each day, from `start_min` until `end_min` in minutes after midnight, as `text` has them.

    Hours that end before they start go on over midnight.
    """

    text: str
    start_min: int
    end_min: int

    def include(self, minute: int) -> bool:
        """True if a minute of the day is within them."""
        if self.start_min <= self.end_min:
            return self.start_min <= minute < self.end_min
        return minute >= self.start_min or minute < self.end_min


def hours(text: str) -> Hours:
    """The hours of a text such as `07:30-18:00`; ValueError where it means none."""
    match = HOURS.fullmatch(text)
    if match is None:
        raise ValueError(text)
    start, start_min, end, end_min = map(int, match.groups())
    whole = Hours(text=text, start_min=start * 60 + start_min, end_min=end * 60 + end_min)
    if whole.end_min > DAY_MIN or whole.start_min == whole.end_min:
        raise ValueError(text)
    return whole


@dataclass(frozen=True, kw_only=True)
class AssistantLimits:
    """Limits of the tasks that assistants give: in which cells, how many at once, and in which hours.

    `hours` are of the clock of the plant's host; None: at any time.
    """

    cells: tuple[str, ...] = ()
    at_once: int = 1
    hours: Hours | None = None


NO_LIMITS = AssistantLimits()
