"""Invariant, its occasions, and the look at the world that it judges by."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from itertools import compress
from operator import attrgetter

from arboleda.rig.moment import Moment
from arboleda.rig.world import World

from ..record import Record
from ..recorded.leaders import Leaders
from ..truth.truth import Truth


@dataclass(kw_only=True)
class Look:
    """The world after one step: what is true and what was said and done so far; `moment`: in this step.

    `whole`: this is one of the looks that an invariant makes every so often, whatever has changed.
    """

    world: World
    truth: Truth
    record: Record
    leaders: Leaders | None = None  # where there are two hosts
    whole: bool = False
    moment: Moment = field(init=False)

    def __post_init__(self) -> None:
        self.moment = self.world.moment


class Trigger(Enum):
    """The steps after which an invariant looks: those in which this part of a `Look` is true or not empty."""

    ALWAYS = "world"
    DEEDS = "truth.deeds"
    ASKED = "moment.requests"
    HEARD = "moment.reports"
    SAID = "record.heard.anew"
    SENT = "moment.sent"
    UNKEPT = "moment.unkept"
    LATE = "moment.late"
    COMMANDED = "record.commands.new"
    TOLD = "record.step.has_spoken"
    TAKEN = "moment.taken"
    PUBLISHED = "moment.published"
    EXECUTED = "moment.executed"
    ORDERED = "moment.ordered"
    BRIDGED_WRONGLY = "record.bridges.wrong"
    UNTOLD = "record.others.untold"
    STEPPED = "record.step.stepped"
    LEFT_OVER = "world.plant.dispatcher.outbox"
    TAUGHT = "record.teachers.taught"
    NEWS = "record.step.news"
    BORN = "record.step.born"
    TOLD_OTHERWISE = "record.starts.wrong"
    DONE_TWICE = "record.starts.twice"
    KEPT_WRONGLY = "record.trails.wrong"
    WAITING = "record.waiting.users"
    IDLE = "record.states.idle"
    CHANGED = "truth.changed"
    MISPLACED = "truth.places.wrong"
    MISSED = "truth.places.missed"
    SWITCHED = "truth.grips.switched"
    DONE_TASKS = "truth.done_tasks"
    BOOKED = "truth.books.ended"
    MET = "truth.zones.meetings"
    FREED = "truth.zones.freed"
    ENTERED = "truth.zones.entries"
    FORMER = "moment.former"
    LED_TWICE = "leaders.twice"
    OLD_NUMBER = "leaders.old"
    WRONG_HISTORY = "leaders.wrong"
    SURE_TOO_LONG = "leaders.sure"
    END = "end"  # once, when everything should be at rest


Rule = Callable[[Look], Iterable[str]]


@dataclass(frozen=True)
class Invariant:
    """A rule yields one sentence per breach; its docstring says what must hold."""

    name: str
    sentence: str
    when: Trigger
    rule: Rule
    every_s: float = math.inf


def invariant(when: Trigger, *, every_s: float = math.inf) -> Callable[[Rule], Invariant]:
    """Make a rule an invariant, named as the function, that looks after the steps of this kind, and after a
    step of the plant that comes `every_s` after the last one at which it did: at its `whole`.
    """

    def make(rule: Rule) -> Invariant:
        return Invariant(rule.__name__, (rule.__doc__ or "").strip(), when, rule, every_s)

    return make


class Judges:
    """Invariants in a row for each Trigger; `looks` counts how often each of them looked."""

    def __init__(self, invariants: Iterable[Invariant]) -> None:
        self._benches = {when: _Bench() for when in Trigger}
        self._rounds = []
        for each in invariants:
            self._benches[each.when].rules.append((each.name, each.rule))
            if each.every_s < math.inf:
                self._rounds.append(_Round(each))
        self._next_round_at = -math.inf
        used = [when for when, bench in self._benches.items() if bench.rules and when is not Trigger.END]
        self._after_a_step = [self._benches[when] for when in used]
        # two more names, as attrgetter returns no tuple for a single one
        self._signs = attrgetter(*(when.value for when in used), "world", "world")

    @property
    def looks(self) -> Counter[str]:
        benches = self._benches.values()
        looks = Counter({name: bench.looks for bench in benches for name, _ in bench.rules})
        looks.update({each.name: each.looks for each in self._rounds})
        return looks

    def after_a_step(self, look: Look) -> Iterator[tuple[str, str]]:
        """Each breach by an invariant that looks after this step: the invariant's name, and its sentence."""
        for bench in compress(self._after_a_step, self._signs(look)):
            bench.looks += 1
            for name, rule in bench.rules:
                for sentence in rule(look):
                    yield name, sentence
        if look.record.step.stepped and look.world.now >= self._next_round_at:
            yield from self._look_around(look)

    def look_around(self, look: Look) -> Iterator[tuple[str, str]]:
        """Each breach by an invariant that looks at the whole every so often: all of them look now."""
        for each in self._rounds:
            each.at = look.world.now
        return self._look_around(look)

    def _look_around(self, look: Look) -> Iterator[tuple[str, str]]:
        """Each breach by an invariant that is to look at the whole now."""
        now, look.whole = look.world.now, True
        try:
            for each in self._rounds:
                if now >= each.at:
                    each.at = now + each.every_s
                    each.looks += 1
                    for sentence in each.rule(look):
                        yield each.name, sentence
        finally:
            look.whole = False
        self._next_round_at = min((each.at for each in self._rounds), default=math.inf)

    def at_the_end(self, look: Look) -> Iterator[tuple[str, str]]:
        """Each breach of an invariant that holds once everything should be at rest."""
        self._benches[Trigger.END].looks += 1
        return self._benches[Trigger.END].breaches(look)

    def is_at_rest(self, look: Look) -> bool:
        """True if everything that must hold at rest holds already."""
        return not any(True for _ in self._benches[Trigger.END].breaches(look))


class _Round:
    """An invariant that looks at the whole every so often; `at`: the time for its next look."""

    def __init__(self, of: Invariant) -> None:
        self.name, self.rule, self.every_s = of.name, of.rule, of.every_s
        self.at = -math.inf
        self.looks = 0


class _Bench:
    """The invariants that look after the same steps."""

    def __init__(self) -> None:
        self.rules: list[tuple[str, Rule]] = []
        self.looks = 0

    def breaches(self, look: Look) -> Iterator[tuple[str, str]]:
        for name, rule in self.rules:
            for sentence in rule(look):
                yield name, sentence
