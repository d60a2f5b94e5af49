"""What an invariant is, and what it may look at."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from itertools import compress
from operator import attrgetter

from ..record import Record
from ..truth import Truth
from ..world import Moment, World


@dataclass(kw_only=True)
class Look:
    """The world after one step, what is true in it, and what was said and done so far."""

    world: World
    truth: Truth
    record: Record

    @property
    def moment(self) -> Moment:
        """What happened in this step."""
        return self.world.moment


class When(Enum):
    """After which steps an invariant is worth a look; the value is what of a `Look` is true, or not empty."""

    ALWAYS = "world"
    ASKED = "world.moment.asked"
    HEARD = "world.moment.heard"
    SENT = "world.moment.sent"
    PUBLISHED = "world.moment.published"
    EXECUTED = "world.moment.executed"
    STEPPED = "record.stepped"
    NEWS = "record.news"
    BORN = "record.born"
    WAITING = "record.waiting"
    CHANGED = "truth.changed"
    PASSED = "truth.parts.passages"
    ENDED = "truth.ended"
    BOOKED = "truth.books.ended"
    MET = "truth.zones.meetings"
    FREED = "truth.zones.freed"
    ENTERED = "truth.zones.entries"
    END = "end"  # once, when everything should be at rest


AFTER_A_STEP = tuple(when for when in When if when is not When.END)
_signs = attrgetter(*(when.value for when in AFTER_A_STEP))


def occasions(look: Look) -> Iterator[When]:
    """What this step gives reason to look at."""
    return compress(AFTER_A_STEP, _signs(look))


Rule = Callable[[Look], Iterable[str]]


@dataclass(frozen=True)
class Invariant:
    """A rule yields one sentence per breach; its docstring says what must hold."""

    name: str
    sentence: str
    when: When
    rule: Rule


def invariant(when: When) -> Callable[[Rule], Invariant]:
    """Make a rule an invariant, named as the function, that is looked at after such steps."""

    def make(rule: Rule) -> Invariant:
        return Invariant(rule.__name__, (rule.__doc__ or "").strip(), when, rule)

    return make
