"""The climate of a run: how many faults it has and of which kinds, drawn from a seed or read from a file."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, fields
from itertools import accumulate
from typing import Any

from arboleda.model.plant_model import PlantModel

from .chance import Dice
from .checks import BadFaults, check_field, is_number, only, within
from .faults import KINDS, NOT_WITH_STANDBY, OF_CRASHES, OF_HOSTS, ON_ONE_HOST, Fault, Kind
from .levels import CRASHES, LEVELS
from .recurring import UNLIKE, Recurring, recurring_from

MINUTE_S = 60.0
HOST_WEIGHT = 3.0  # with a standby: beside one of each other kind
CRASH_WEIGHT = 8.0  # beside one of each other kind

ABSENT = 0.25  # the share of kinds that a seed does without
FIELDS = tuple(each.name for each in fields(Fault))
KEYS = ("plant", "seconds", "people", "rates", "faults", UNLIKE)  # the first three are read elsewhere


@dataclass(frozen=True, kw_only=True)
class Climate:
    """The faults of one run: `rates` of each kind per minute are drawn from; `fixed_faults` have their time,
    and `recurring` their figures.

    The same climate gives the same faults for a minute, whichever minutes were asked for before.
    """

    model: PlantModel
    seed: int
    rates: Mapping[str, float]
    fixed_faults: tuple[Fault, ...] = ()
    recurring: tuple[Recurring, ...] = ()

    @classmethod
    def draw(cls, model: PlantModel, seed: int, level: str, *, standby: bool = False) -> Climate:
        """The climate that a seed gives at one of the LEVELS: a total rate, shared among kinds of fault.

        `standby`: the plant has two hosts, so faults of hosts are possible too.
        """
        if level not in LEVELS:
            raise BadFaults(f"{level!r} is not a level of faults; there are {', '.join(LEVELS)}")
        dice, (low, high) = Dice(seed, "climate"), LEVELS[level]
        total = low * (high / low) ** dice.random() if low else 0.0
        judged = _possible(standby=standby)
        kinds = {name: kind for name, kind in KINDS.items() if name in judged and kind.targets(model)}
        weights = {name: _weight(dice, _weight_at(level, kind)) for name, kind in kinds.items()}
        return cls(model=model, seed=seed, rates=_shared(round(total, 3), weights))

    @classmethod
    def from_file(cls, model: PlantModel, seed: int, data: Any, *, standby: bool = False) -> Climate:
        """The climate in a file: `{"rates": {kind: per minute}}`, `{"faults": [{"kind": ..., "at": s}]}`,
        what devices did under `unlike`, or all of that.

        Whatever such a fault leaves out is drawn; raises BadFaults for the first entry that is wrong.
        """
        known = only(data, KEYS, "the file")
        with within("rates"):
            rates = _rates(known.get("rates", {}))
        listed = known.get("faults", [])
        if not isinstance(listed, list):
            raise BadFaults('faults is not a list, e.g. [{"kind": "reboot", "at": 12.5}]', "faults")
        from_list: list[Fault] = []
        for number, each in enumerate(listed):
            with within("faults", number):
                from_list.append(_fault_from(model, Dice(seed, "told", number), each))
        recurring = recurring_from(model, known.get(UNLIKE, []))
        for name in (*rates, *(fault.kind for fault in from_list), *(each.name for each in recurring)):
            _refuse_hosts(name, standby=standby)
        return cls(model=model, seed=seed, rates=rates, fixed_faults=tuple(from_list), recurring=recurring)

    def faults(self, minute: int) -> list[Fault]:
        """The faults that begin in a minute of the run, in the order of their times."""
        begin, dice = minute * MINUTE_S, Dice(self.seed, "faults", minute)
        drawn = [self._fault(dice, begin) for _ in range(_count(dice, sum(self.rates.values())))]
        listed = [fault for fault in self.fixed_faults if begin <= fault.at < begin + MINUTE_S]
        return sorted([*listed, *drawn, *self._recurring(minute)], key=lambda fault: fault.at)

    def _recurring(self, minute: int) -> Iterator[Fault]:
        for number, each in enumerate(self.recurring):
            dice = Dice(self.seed, UNLIKE, minute, number)
            for _ in range(_count(dice, each.per_minute)):
                at = round(minute * MINUTE_S + dice.below(60_000) / 1000, 3)
                yield each.drawn(dice, self.model, at)

    def _fault(self, dice: Dice, begin: float) -> Fault:
        name = _one_of(dice, self.rates)
        at = round(begin + dice.below(60_000) / 1000, 3)
        return Fault(kind=name, at=at, seed=dice.below(2**32), **KINDS[name].draw(dice, self.model))


def _possible(*, standby: bool) -> Collection[str]:
    here = [name for name in ON_ONE_HOST if name not in NOT_WITH_STANDBY]
    return [*here, *OF_HOSTS] if standby else ON_ONE_HOST


def _refuse_hosts(name: str, *, standby: bool) -> None:
    if name in OF_HOSTS and not standby:
        raise BadFaults(f"{name} befalls a plant with two hosts: simulate it with --standby")
    if name in NOT_WITH_STANDBY and standby:
        raise BadFaults(f"{name} befalls a plant on one host: leave out --standby, or take leader_killed")


def _weight_at(level: str, kind: Kind) -> float:
    if kind.name in OF_HOSTS:
        return HOST_WEIGHT
    return CRASH_WEIGHT if level == CRASHES and kind.name in OF_CRASHES else kind.weight


def _weight(dice: Dice, weight: float) -> float:
    share = dice.between(0.2, 1.8)
    return 0.0 if dice.chance(ABSENT) else weight * share


def _shared(total: float, weights: Mapping[str, float]) -> dict[str, float]:
    whole = sum(weights.values())
    return {name: total * weight / whole for name, weight in weights.items() if total and weight}


def _count(dice: Dice, mean: float) -> int:
    """A whole number, drawn so that its mean is this."""
    return int(mean) + dice.chance(mean % 1.0)


def _one_of(dice: Dice, rates: Mapping[str, float]) -> str:
    *_, whole = sums = list(accumulate(rates.values()))
    drawn = dice.random() * whole
    return next(name for name, below in zip(rates, sums, strict=True) if drawn < below)


def _rates(data: Any) -> dict[str, float]:
    rates = only(data, tuple(KINDS), "rates")
    for name, rate in rates.items():
        if not is_number(rate) or rate < 0:
            raise BadFaults(f"rates: {name} is {rate!r}; a number of faults per minute is needed", name)
    return rates


def _fault_from(model: PlantModel, dice: Dice, data: Any) -> Fault:
    entry = only(data, FIELDS, "a fault")
    for name in entry:
        check_field(name, entry[name])
    kind = KINDS.get(entry.get("kind", ""))
    if kind is None:
        raise BadFaults(f"{entry.get('kind')!r} is not a kind of fault; there are {', '.join(KINDS)}")
    if "at" not in entry:
        raise BadFaults(f"{kind.name}: at is missing; it is in s since the run began")
    targets = kind.targets(model)
    if not targets or entry.get("target", targets[0]) not in targets:
        raise BadFaults(kind.objection(Fault(**entry), model) or f"{kind.name} cannot happen in this plant")
    drawn = {"seed": dice.below(2**32), **kind.draw(dice, model, entry.get("target"))}
    fault = Fault(**{**drawn, **entry})
    if (objection := kind.objection(fault, model)) is not None:
        raise BadFaults(objection)
    return fault
