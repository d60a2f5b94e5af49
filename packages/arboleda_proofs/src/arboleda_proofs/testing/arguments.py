"""Conversion of a test's words - a plant file, a robot, a fault - into what the simulator takes."""

from __future__ import annotations

import math
from pathlib import Path

from arboleda.extension import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda_proofs.campaigns.plants import Plant
from arboleda_proofs.simulator.chance import Dice
from arboleda_proofs.simulator.faults import ON_ONE_HOST, Fault
from arboleda_proofs.simulator.faults.kind import NONE, Kind

from .words import Misuse, known

__tracebackhide__ = True
PLAIN = {
    "reboot": "no will"
}  # the word of a kind, for tests that name none: seen as a reboot, not a lost link


def plant(named: PlantModel | Path | str | None, folder: Path | None) -> PlantModel:
    """The plant, each of its robots with a virtual board; raises Misuse with every mistake of its file."""
    try:
        if isinstance(named, PlantModel):
            return Plant(declared=named).model
        declared = loader.load(_file(Path(named), folder) if named is not None else None)
        return Plant(declared=declared).model
    except ConfigError as error:
        raise Misuse(str(error)) from None


def robot(name: str, model: PlantModel) -> str:
    """The name of a robot, looked up by that name or by its name on MQTT."""
    by_mqtt = {each.mqtt: each.name for each in model.robots.values()}
    return by_mqtt.get(name) or known("a robot of this plant", name, model.robots)


def fault(
    model: PlantModel,
    kind: str,
    target: str,
    *,
    at: float,
    seconds: float | None,
    amount: float | None,
    word: str | None,
    seed: int,
) -> Fault:
    """The fault; word and amount are drawn if they are None, it has no end if seconds are None."""
    of_kind = ON_ONE_HOST[known("a kind of fault", kind, ON_ONE_HOST)]
    target = _target(of_kind, target, model)
    drawn = of_kind.draw(Dice(seed, "left out"), model, target)
    lasting = math.inf if of_kind.seconds != NONE else 0.0
    fault = Fault(
        kind=of_kind.name,
        at=at,
        seconds=lasting if seconds is None else seconds,
        target=target,
        amount=drawn["amount"] if amount is None else amount,
        word=PLAIN.get(of_kind.name, drawn["word"]) if word is None else word,
        seed=seed,
    )
    must_fit(fault, model)
    return fault


def must_fit(fault: Fault, model: PlantModel) -> None:
    """Raise Misuse if there can be no such fault in this plant."""
    objection = ON_ONE_HOST[known("a kind of fault", fault.kind, ON_ONE_HOST)].objection(fault, model)
    if objection is not None:
        raise Misuse(objection)


def _target(kind: Kind, target: str, model: PlantModel) -> str:
    """The target of a fault: by its own name, the robot's other name, or the only possible one."""
    allowed = list(dict.fromkeys(kind.targets(model)))
    if target in allowed:
        return target
    if not allowed:
        raise Misuse(f"{kind.name} cannot happen in this plant")
    if not target and len(allowed) == 1:
        return allowed[0]
    if not target:
        raise Misuse(f"{kind.name} needs a target; there are {', '.join(allowed)}")
    other = {each.name: each.mqtt for each in model.robots.values()}
    other |= {each.mqtt: each.name for each in model.robots.values() if each.mqtt not in other}
    if other.get(target) in allowed:
        return other[target]
    return known(f"what {kind.name} can befall in this plant", target, allowed)


def _file(named: Path, folder: Path | None) -> Path:
    beside = folder / named if folder is not None else named
    return beside if beside.exists() else named
