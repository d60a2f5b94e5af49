"""Representatives: of all instants that are one for a fault, the instant at which it is tried.

It is just before a step begins, else in the middle between two events, else just after one; in the first
scenario of the recipe that has such an instant, and there the last one: the least is left to run behind it.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

from arboleda.model.plant_model import Cell, PlantModel
from arboleda.rig.plant_process import Side
from arboleda_proofs.simulator.faults import COUNTED, KINDS, OF_QUEUES, STICKING, UNHEARD, Fault
from arboleda_proofs.simulator.faults.operators import NOWHERE
from arboleda_proofs.simulator.recurring import Recurring

from .calm import Calm
from .instants import Instant
from .sights import TASK, Refusals
from .single_faults import possible_kinds, single_faults

Place = tuple[int, int]  # numbers of a scenario and of an instant in it
BEFORE, NOTHING = Side.BEFORE.value, "nothing"
FIRSTS = 0  # the number of the part with one fault of each kind at each kind of step


@dataclass(frozen=True, kw_only=True)
class Representatives:
    """Faults that are tried at each instant of each scenario. `kinds`: only faults of these; none: of all.

    `every`: each fault at each instant is tried, those that others represent last. `seen`: also these, which
    devices had.
    """

    model: PlantModel
    calm: Sequence[Calm]
    kinds: tuple[str, ...] = ()
    every: bool = False
    seen: Sequence[Recurring] = ()

    @cached_property
    def parts(self) -> dict[Place, list[list[Fault]]]:
        """The faults of each instant: FIRSTS, the parts of `single_faults`, those that others represent."""
        classes, steps = set[Hashable](), set[Hashable]()
        parts: dict[Place, list[list[Fault]]] = {}
        for place in self._in_turn:
            firsts, others = list[Fault](), list[Fault]()
            step, rest = self._step(place), list[list[Fault]]()
            for faults in self._faults(place):
                rest.append([])
                for fault in faults:
                    if not _is_new(self.class_of(place, fault), classes):
                        others.append(fault)
                    elif _is_new((step, fault.kind), steps):
                        firsts.append(fault)
                    else:
                        rest[-1].append(fault)
            parts[place] = [firsts, *rest, others if self.every else []]
        return dict(sorted(parts.items()))

    @cached_property
    def total(self) -> int:
        """The number of all faults at all instants, represented ones as well."""
        counts: dict[tuple[str, int], int] = {}
        total = 0
        for place in self._places:
            key = self.calm[place[0]].scenario.cell, self._instant(place).commits
            if key not in counts:
                counts[key] = sum(map(len, self._faults(place)))
            total += counts[key]
        return total

    @property
    def _in_turn(self) -> Iterator[Place]:
        """The instants in the order in which they represent; `every`: also those that others represent."""
        known = set[Hashable]()
        for place in sorted(self._places, key=self._turn):
            if _is_new(self._all_met(place), known) or self.every:
                yield place

    def _turn(self, place: Place) -> tuple[int, int, int]:
        """The turn of an instant among those of its class."""
        row, number = place
        return self._instant(place).level, row, -number

    def _all_met(self, place: Place) -> Hashable:
        """All that faults can meet at an instant."""
        robots = (None, TASK, *(robot.name for robot in self._cell(place).robots))
        sights = tuple(self._sight(place, *each) for each in product(robots, self._spans))
        calm, spans = self.calm[place[0]], {each for kind in STICKING for each in KINDS[kind].seconds}
        told = tuple(calm.sights.told_otherwise(self._instant(place), each) for each in sorted(spans))
        refused = frozenset(self._refused(place).items())
        return self._step(place), self._instant(place).commits, sights, told, refused

    @property
    def _places(self) -> Iterator[Place]:
        return ((row, number) for row, calm in enumerate(self.calm) for number in range(len(calm.instants)))

    @cached_property
    def _spans(self) -> list[float]:
        """The spans of all faults, s."""
        seen = {each.known.get("seconds", 0.0) for each in self.seen}
        return sorted(seen | {seconds for kind in possible_kinds() for seconds in kind.seconds})

    @cached_property
    def _targets(self) -> dict[str, str | None]:
        """The robot that a target is, by the names of robots and of their boards; TASK: it is nothing."""
        robots = self.model.robots.values()
        return {NOWHERE: TASK, **{name: each.name for each in robots for name in (each.mqtt, each.name)}}

    @cached_property
    def _sights(self) -> dict[Hashable, Hashable]:
        return {}

    def _sight(self, place: Place, robot: str | None, lasts_s: float) -> Hashable:
        key = place, robot, lasts_s
        if key not in self._sights:
            sight = self.calm[place[0]].sights.of(self._instant(place), robot, lasts_s)
            self._sights[key] = self._sights.setdefault(sight, len(self._sights))
        return self._sights[key]

    def class_of(self, place: Place, fault: Fault) -> Hashable:
        """The class of a fault at an instant; of each class one fault is tried, at one instant, in one of the
        words that are alike.
        """
        scenario = self.calm[place[0]].scenario
        return scenario.cell, scenario.recipe, self._meets(place, fault), _form(fault)

    def _meets(self, place: Place, fault: Fault) -> Hashable:
        """The sight of a fault at an instant, or the reason why it meets nothing."""
        sights, instant = self.calm[place[0]].sights, self._instant(place)
        robot = TASK if fault.kind in OF_QUEUES else self._targets.get(fault.target)
        refused = self._refused(place).get((fault.kind, fault.target, fault.word))
        if refused is not None:
            return refused
        field = fault.target, fault.word
        if fault.kind in STICKING and not sights.tells_otherwise(field, instant, fault.seconds):
            return NOTHING
        if KINDS[fault.kind].alike(fault.word) == UNHEARD:
            return sights.doing(instant, robot)
        return self._sight(place, robot, fault.seconds)

    def _refused(self, place: Place) -> Refusals:
        return self.calm[place[0]].sights.refused(self._instant(place))

    def _step(self, place: Place) -> Hashable:
        calm = self.calm[place[0]]
        return calm.scenario.cell, calm.scenario.recipe, calm.sights.step(self._instant(place))

    def _faults(self, place: Place) -> list[list[Fault]]:
        return single_faults(
            self.model,
            self._cell(place),
            self._instant(place),
            number=place[1],
            only=self.kinds,
            seen=self.seen,
        )

    def _instant(self, place: Place) -> Instant:
        return self.calm[place[0]].instants[place[1]]

    def _cell(self, place: Place) -> Cell:
        return self.model.cell(self.calm[place[0]].scenario.cell)


def _form(fault: Fault) -> Hashable:
    """The form of a fault; a death behind a commit is one before the next one."""
    if fault.kind in COUNTED:
        return fault.kind, fault.target, fault.amount - (fault.word == BEFORE), fault.seconds
    return fault.kind, fault.target, KINDS[fault.kind].alike(fault.word), fault.amount, fault.seconds


def _is_new(key: Hashable, known: set[Hashable]) -> bool:
    """True where a key is not among those that are known; it is from then on."""
    before = len(known)
    known.add(key)
    return len(known) > before
