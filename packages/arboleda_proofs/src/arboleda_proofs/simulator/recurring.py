"""Faults of devices that were seen: each has what was seen of it, and comes again and again.

A file has them under `unlike`, as `arboleda record unlike --to` writes it. A row names a device by its number
in the plant file, and a fact by its number in the device's kind; a row without a `fault` is of what the
simulator cannot play.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import Robot, among, quoted
from arboleda.model.plant_model import PlantModel

from .chance import Dice
from .checks import BadFaults, check_field, is_number, within
from .faults import KINDS, Fault
from .faults.kind import Kind

UNLIKE = "unlike"
ROW = ("what", "device", "driver", "word", "seconds", "amount", "times", "per_minute", "fault")
FIGURES = ("kind", "seconds", "amount", "word", "fact")
MOST_A_MINUTE = 10.0


@dataclass(frozen=True, kw_only=True)
class Recurring:
    """Fault that comes `per_minute` times on average; `known` is what is known of it, the rest is drawn."""

    per_minute: float
    name: str
    known: Mapping[str, Any]

    @property
    def kind(self) -> Kind:
        return KINDS[self.name]

    def drawn(self, dice: Dice, model: PlantModel, at: float) -> Fault:
        """The fault at a time, with the rest drawn."""
        drawn = self.kind.draw(dice, model, self.known.get("target"))
        return Fault(kind=self.name, at=at, seed=dice.below(2**32), **{**drawn, **self.known})

    def hardest(self, model: PlantModel, at: float) -> Iterator[Fault]:
        """The fault at a time, with the most of the rest, at each target."""
        rest = {"seconds": self.kind.seconds[1], "amount": self.kind.amount[1]}
        target = self.known.get("target")
        for each in dict.fromkeys(self.kind.targets(model)) if target is None else (target,):
            word = self.kind.words(model, each)[0]
            yield Fault(kind=self.name, at=at, **{**rest, "target": each, "word": word, **self.known})


def recurring_from(model: PlantModel, rows: Any) -> tuple[Recurring, ...]:
    """The faults of a file's rows; raises BadFaults for the first row that is wrong."""
    with within(UNLIKE):
        if not isinstance(rows, list):
            raise BadFaults("unlike is not a list; `arboleda record unlike --to FILE` writes one")
        found: list[Recurring] = []
        for number, row in enumerate(rows):
            with within(number):
                found += _from(model, row)
        return tuple(found)


def _from(model: PlantModel, row: Any) -> Iterator[Recurring]:
    known = _mapping(row, ROW, "a row of unlike")
    if "fault" not in known:
        return
    per_minute = known.get("per_minute", 1.0)
    if not is_number(per_minute) or not 0 <= per_minute <= MOST_A_MINUTE:
        raise BadFaults(
            f"per_minute is {quoted(per_minute)}; a number from 0 to {MOST_A_MINUTE:g} is needed",
            "per_minute",
        )
    robot = _robot(model, known)
    with within("fault"):
        yield _recurring(model, robot, _mapping(known["fault"], FIGURES, "the fault"), float(per_minute))


def _recurring(
    model: PlantModel, robot: Robot | None, told: Mapping[str, Any], per_minute: float
) -> Recurring:
    name = told.get("kind")
    kind = KINDS.get(name) if isinstance(name, str) else None
    if kind is None:
        raise BadFaults(f"{quoted(name)} is no kind of fault; {among(str(name), KINDS)}", "kind")
    known = {key: told[key] for key in ("seconds", "amount", "word") if key in told}
    for key, value in known.items():
        with within(key):
            check_field(key, value)
    known |= {} if robot is None else {"target": robot.mqtt}
    known |= {"word": _fact(robot, told["fact"])} if "fact" in told else {}
    found = Recurring(per_minute=per_minute, name=kind.name, known=known)
    faults = [*found.hardest(model, 0.0)]
    for fault in faults:
        if (objection := kind.objection(fault, model)) is not None:
            raise BadFaults(objection)
    if not faults:
        raise BadFaults(f"{kind.name} cannot happen in this plant")
    return found


def _robot(model: PlantModel, row: Mapping[str, Any]) -> Robot | None:
    """The device of a row; None for any that the fault can befall."""
    if "device" not in row:
        return None
    robots, number = [*model.robots.values()], row["device"]
    if type(number) is not int or not 1 <= number <= len(robots):
        raise BadFaults(f"device is {quoted(number)}; the plant has devices 1 to {len(robots)}", "device")
    return robots[number - 1]


def _fact(robot: Robot | None, number: Any) -> str:
    facts = robot.fact_names if robot is not None and robot.verb_names else ()
    if type(number) is not int or not 1 <= number <= len(facts):
        raise BadFaults(f"fact is {quoted(number)}; the device has facts 1 to {len(facts)}", "fact")
    return facts[number - 1]


def _mapping(data: Any, allowed: tuple[str, ...], where: str) -> Mapping[str, Any]:
    if not isinstance(data, dict):
        raise BadFaults(f"{where} is not a mapping; its keys are {', '.join(allowed)}")
    for key in data:
        if key not in allowed:
            raise BadFaults(f"{where} has no {quoted(key)}; {among(str(key), allowed)}", key)
    return data
