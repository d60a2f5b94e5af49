"""Sights of a calm run: what a fault meets that begins at an instant. Instants of one sight are one for it.

A sight has what the engine tells apart, as far as the fault can touch that:

- what its target does: the kind of each open command, and how far that is (sent, taken, at work); of a
  fault of the plant, the bridge, the broker or a cell: of all devices of the cell;
- the facts that the plant believes of a target that is a device;
- the state of the cell, and the grips of its robots: they decide what a failure leads to;
- whether its target gets any command later, and again one of the kind at which it is: that decides what
  becomes of what went wrong;
- the first event of its target while the fault lasts, and whether the fault lasts beyond that.

Of what somebody says and the plant refuses then, the refusal is the sight: it leaves nothing.

It leaves out where a robot goes and which zones it has, which values a device gets, what other devices do,
and how far away that event is. So a step that comes again with another place, and each round of a loop but
the last, has the sight of the first one. What that costs is measured in decision 72.
"""

from __future__ import annotations

import json
from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from arboleda.engine import Entry, Plant
from arboleda.engine.inspection import beliefs_of, grips_of, ledger_of
from arboleda.model.messages import TaskChanged
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.wire.topics import Channel, topic
from arboleda_proofs.simulator.faults import KINDS, Fault
from arboleda_proofs.simulator.faults.kind import never_refused

from .instants import LONG_S, US, Instant, Side
from .single_faults import possible_kinds, single_faults
from .stage import Stage

Words = tuple[Hashable, ...]
Form = tuple[str, str, str]  # of a fault: its kind, its target and its word
Refusals = Mapping[Form, str]  # by the key of the reason
Field = tuple[str, str]  # of telemetry: its board, its name
BEGINS, ENDS = "begins", "ends"
TASK = ""  # to which something happens that happens to no robot


@dataclass(frozen=True, kw_only=True)
class Standing:
    """Standing of a cell: what each of its robots does and says, its state, and the grips of its robots."""

    doing: Mapping[str, tuple[Words, ...]] = field(default_factory=dict)
    saying: Mapping[str, Words] = field(default_factory=dict)
    state: Words = ()
    grips: Words = ()


@dataclass(frozen=True, kw_only=True)
class Happening:
    """Event of a run `at` s: it happens to a robot, or to the `TASK`."""

    at: float
    robot: str
    words: Words


class Track:
    """Events of one robot, or of all, in the order of time."""

    def __init__(self, happenings: Sequence[Happening]) -> None:
        self._happenings = happenings
        self._times = [round(each.at, 6) for each in happenings]
        kinds = [frozenset[Words]()]
        for each in reversed(happenings):
            begins = {(each.robot, *each.words[1:])} if each.words[0] == BEGINS else frozenset[Words]()
            kinds.append(kinds[-1] | begins)
        self._to_come = kinds[::-1]

    def later(self, instant: Instant, events: int) -> frozenset[Words]:
        """The kinds of the commands that are given behind so many events from an instant on."""
        return self._to_come[_find(instant)(self._times, instant.at) + events]

    def first(self, instant: Instant, lasts_s: float) -> Iterator[Words]:
        """The first thing that happens while a fault lasts that begins at an instant, with all at that time.

        Each with whether the fault lasts beyond it, and so meets what follows.
        """
        ends = until = instant.at + lasts_s + US
        for number in range(_find(instant)(self._times, instant.at), len(self._times)):
            each = self._happenings[number]
            if each.at > until:
                return
            until = each.at + US
            yield each.robot, *each.words, each.at + LONG_S < ends


@dataclass(frozen=True, kw_only=True)
class Sights:
    """Sights of a run: the standings of a cell, and what would be refused, each with the time from which that
    was so, the events, and when boards told otherwise than before, by what they told.
    """

    standings: tuple[tuple[float, Standing], ...]
    refusals: tuple[tuple[float, Refusals], ...]
    happenings: tuple[Happening, ...]
    told: Mapping[Field, Sequence[float]]

    def of(self, instant: Instant, robot: str | None, lasts_s: float) -> Words:
        """The sight of a fault of a robot that begins at an instant and lasts so long.

        None: a fault of all robots; `TASK`: of none.
        """
        standing, track = self._standing(instant), self._track(robot)
        first = tuple(track.first(instant, lasts_s))
        if robot == TASK:
            return standing.state, first
        own = self.doing(instant, robot)
        says = standing.saying.get(robot) if robot else None
        return standing.grips, own, says, self._again(instant, robot, first), first

    def doing(self, instant: Instant, robot: str | None) -> Words:
        """The state of the cell at an instant, and what a robot does then; None: what each does."""
        standing = self._standing(instant)
        names = standing.doing if robot is None else (robot,)
        return standing.state, *((name, standing.doing.get(name)) for name in names)

    def told_otherwise(self, instant: Instant, lasts_s: float) -> frozenset[Field]:
        """All of which a board tells otherwise than before within so long after an instant."""
        return frozenset(each for each in self.told if self.tells_otherwise(each, instant, lasts_s))

    def tells_otherwise(self, field: Field, instant: Instant, lasts_s: float) -> bool:
        """True if a board tells a field otherwise than before within so long after an instant."""
        times = self.told.get(field, ())
        first = bisect_left(times, instant.at)
        return first < len(times) and times[first] <= instant.at + lasts_s + US

    def _again(self, instant: Instant, robot: str | None, first: tuple[Words, ...]) -> Words:
        """The kinds of commands that are open or given with the first event and that are given again later;
        and whether any is.
        """
        doing = self._standing(instant).doing
        names = doing if robot is None else (robot,)
        now = {(name, *words[:2]) for name in names for words in doing.get(name, ())}
        now |= {(who, *words[:2]) for who, what, *words in first if what == BEGINS}
        later = self._track(robot).later(instant, len(first))
        return *sorted(now & later), bool(later)

    def refused(self, instant: Instant) -> Refusals:
        """All that somebody may say, and the plant would refuse at an instant."""
        number = _find(instant)(self._times_of_refusals, instant.at)
        return self.refusals[number - 1][1] if number else {}

    def step(self, instant: Instant) -> Words:
        """The kind of step at which the cell is."""
        ahead = self._track(None).first(instant, 0.0) if instant.side is Side.BEFORE else ()
        return tuple(self._standing(instant).doing.items()), *ahead

    def _standing(self, instant: Instant) -> Standing:
        number = _find(instant)(self._times, instant.at)
        return self.standings[number - 1][1] if number else Standing()

    def _track(self, robot: str | None) -> Track:
        if robot not in self._tracks:
            self._tracks[robot] = Track([each for each in self.happenings if robot in (None, each.robot)])
        return self._tracks[robot]

    @cached_property
    def _tracks(self) -> dict[str | None, Track]:
        return {}

    @cached_property
    def _times(self) -> list[float]:
        return [round(at, 6) for at, _ in self.standings]

    @cached_property
    def _times_of_refusals(self) -> list[float]:
        return [round(at, 6) for at, _ in self.refusals]


def _find(instant: Instant) -> Callable[[Sequence[float], float], int]:
    """The function that counts the times before an instant, with its event's where it lies after that."""
    return bisect_left if instant.side is Side.BEFORE else bisect_right


class Watch:
    """Watch of a stage: takes its sights until its task has ended."""

    def __init__(self, stage: Stage) -> None:
        self._stage, self._standings, self._happenings = stage, [(0.0, Standing())], list[Happening]()
        self._refusals, self._version = list[tuple[float, Refusals]](), -1
        self._verbs = _verbs(stage.world.model, stage.cell)
        self._fields, self._told = dict[Field, object](), defaultdict[Field, list[float]](list)
        stage.world.watchers.append(self._look)

    @property
    def sights(self) -> Sights:
        """The sights so far."""
        return Sights(
            standings=tuple(self._standings),
            refusals=tuple(self._refusals),
            happenings=tuple(self._happenings),
            told=dict(self._told),
        )

    def _look(self) -> None:
        now = standing(self._stage.world.plant, self._stage.cell)
        if now != self._standings[-1][1]:
            self._standings.append((self._stage.watched.seconds, now))
        if self._version != self._stage.world.plant.version and not self._stage.ended:
            self._version = self._stage.world.plant.version
            self._refusals.append((self._stage.watched.seconds, dict(self._refused())))
        for key, value in self._fields_told():
            if self._fields.get(key) != value:
                self._fields[key] = value
                self._told[key].append(round(self._stage.watched.seconds, 6))
        for robot, words in self._happened():
            self._happenings.append(Happening(at=self._stage.watched.seconds, robot=robot, words=words))

    def _refused(self) -> Iterator[tuple[Form, str]]:
        for form, verb in self._verbs.items():
            refusal = KINDS[verb.kind].refusal(self._stage.world, verb)
            if refusal is not None:
                yield form, refusal.key

    def _fields_told(self) -> Iterator[tuple[Field, object]]:
        """All fields of each telemetry of this step, its facts among them; None of those that it lacks."""
        for name, publication in self._stage.world.moment.published:
            if publication.topic == topic(name, Channel.TELEMETRY):
                fields = json.loads(publication.payload)
                fields |= fields.get("datos") or {}
                lacks = [each for board, each in self._fields if board == name and each not in fields]
                yield from (((name, each), fields.get(each)) for each in (*fields, *lacks))

    def _happened(self) -> Iterator[tuple[str, Words]]:
        moment, entries = self._stage.world.moment, ledger_of(self._stage.world.plant).entries
        for message in moment.sent:
            entry = entries.get(getattr(message, "id", ""))
            if entry is not None:
                yield entry.command.robot, (BEGINS, *kind(entry))
            elif isinstance(message, TaskChanged):
                yield TASK, (message.state.value,)
        for ended in self._stage.watched.truth.books.ended:
            yield ended.entry.command.robot, (ENDS, *kind(ended.entry))
        yield from ((TASK, (type(request).__qualname__,)) for request in moment.requests)


def standing(plant: Plant, cell: Cell) -> Standing:
    """The standing of a cell now."""
    run, ledger, beliefs = plant.cells[cell.name], ledger_of(plant), beliefs_of(plant)
    grips, names = grips_of(plant).by_holder, [robot.name for robot in cell.robots]
    return Standing(
        doing={name: tuple(map(_doing, ledger.of_robot(name))) for name in names},
        saying={name: tuple(beliefs[name].facts.items()) for name in names},
        state=(run.state.value, run.task is not None),
        grips=tuple((name, grips[name].value) for name in names if name in grips),
    )


def _verbs(model: PlantModel, cell: Cell) -> dict[Form, Fault]:
    """All that somebody may say and the plant may refuse."""
    kinds = [each.name for each in possible_kinds() if each.refusal is not never_refused]
    parts = single_faults(model, cell, Instant(at=0.0, side=Side.AFTER, what=""), only=kinds)
    return {(each.kind, each.target, each.word): each for part in parts for each in part}


def kind(entry: Entry) -> Words:
    """The kind of a command: its class, and the verb or the word that a plant file has for it."""
    return type(entry.command).__qualname__, entry.command.word


def _doing(entry: Entry) -> Words:
    return *kind(entry), entry.state.value, entry.observations.moving
