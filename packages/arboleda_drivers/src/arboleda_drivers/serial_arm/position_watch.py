"""Watch over the positions that servos tell: one that is repeated while its servo should move is old."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from .servos import Reading

OLD_TICKS = 6  # a servo that should have gone so far since its position changed tells an old one
SURE_TICKS = 40  # and by then something is wrong with it, even where it goes at a tenth of its speed
STUCK_S = 0.3  # which is told within 0.5 s, rounds of questions included


@dataclass(frozen=True, kw_only=True)
class Plan:
    """Move as servos were told it: goals in ticks, speeds in ticks/s, reached at `begins_at`; times in s."""

    told_at: float
    goals: Mapping[int, int]
    speeds: Mapping[int, float]
    begins_at: float
    ends_at: float


NOTHING = Plan(told_at=0.0, goals={}, speeds={}, begins_at=0.0, ends_at=0.0)


@dataclass(frozen=True, kw_only=True)
class Word:
    """Position of a servo, since when it is told, and until when, s."""

    position: int
    since: float
    until: float


class PositionWatch:
    """Watch over the servos of one arm; `unknown` are those that hold without a position to hold at."""

    def __init__(self) -> None:
        self.unknown: set[int] = set()
        self._excused: set[int] = set()  # a person has seen to them
        self._words: dict[int, Word] = {}
        self._plan = NOTHING

    def begin(self, plan: Plan) -> None:
        """Servos are told to move."""
        self._plan = plan
        self.unknown.clear()
        self._excused.clear()

    def end(self) -> None:
        """Servos are told to stop."""
        self._plan = NOTHING

    def excuse(self, ids: Collection[int]) -> None:
        """A person has looked at these servos: they are no trouble any more."""
        self._excused.update(ids)

    def see(self, readings: Mapping[int, Reading]) -> bool:
        """Take the readings of a round; True where a servo tells its position again that was unknown."""
        changed = set()
        for id, reading in readings.items():
            before = self._words.get(id)
            repeats = before is not None and before.position == reading.position
            since = before.since if before is not None and repeats else reading.at
            self._words[id] = Word(position=reading.position, since=since, until=reading.at)
            changed |= set() if repeats else {id}
        returned = self.unknown & changed
        self.unknown -= changed
        self._excused -= changed
        return bool(returned)

    @property
    def awaits(self) -> bool:
        """True while a servo is to tell where it is, so that it can hold there."""
        return not self.unknown <= self._excused

    def is_old(self, id: int) -> bool:
        """True where a servo repeats its position, and should have gone on meanwhile."""
        return id in self.unknown or self._missed(id) >= OLD_TICKS

    def gone(self, id: int, since: float, now: float, *, at_most_s: float) -> float:
        """The ticks that a servo may have gone between two times, if it knows no ramp; in no known move
        `at_most_s` a second.
        """
        if self._plan is NOTHING:
            return at_most_s * (now - since)
        return self._plan.speeds.get(id, 0.0) * max(0.0, now - max(since, self._plan.told_at))

    def stuck(self) -> list[int]:
        """The servos whose position has not changed for too long."""
        long = [id for id, word in self._words.items() if word.until - word.since >= STUCK_S]
        sure = [id for id in long if id in self.unknown or self._missed(id) >= SURE_TICKS]
        return [id for id in sure if id not in self._excused]

    def _missed(self, id: int) -> float:
        """The ticks that a servo should have gone while it told one position; 0 for one near its goal."""
        word, plan = self._words.get(id), self._plan
        if word is None or abs(plan.goals.get(id, word.position) - word.position) < SURE_TICKS:
            return 0.0
        seconds = min(word.until, plan.ends_at) - max(word.since, plan.begins_at)
        return plan.speeds.get(id, 0.0) * max(0.0, seconds)
