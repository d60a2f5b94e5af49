"""End states: what is truly so when a task is called done, and in what two of them differ."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from arboleda.drivers import Value, shown
from arboleda.engine.inspection import beliefs_of
from arboleda.model.plant_model import Cell
from arboleda.model.recipe import nearest
from arboleda_proofs.simulator.judged_world import JudgedWorld
from arboleda_proofs.simulator.truth.arm import ArmTruth

NEAR = 2e-3  # rad, m or grid nodes: two places that are as near to each other are one
KNOWN = " (the plant was told: a check would notice)"
UNKNOWN = " (its board had not said so)"
EndState = Mapping[str, object]


def end_state(watched: JudgedWorld, cell: Cell) -> dict[str, object]:
    """The true facts, places and loads of a cell's devices, and how many parts lie where, by their names."""
    found: dict[str, object] = {}
    for robot in cell.robots:
        truth = watched.truth.robots.get(robot.name)
        if truth is None:
            continue
        found |= {f"{robot.name}.{fact}": value for fact, value in truth.body.true_facts.items()}
        if truth.body.true_place is not None:
            found[f"the place of {robot.name}"] = truth.body.true_place
        if isinstance(truth, ArmTruth) and robot.has_effector:
            found[f"the part in {robot.name}"] = truth.holding
    return found | dict(_parts(watched, cell))


def stated(cell: Cell, recipe: str, values: Mapping[str, object], found: EndState) -> Mapping[str, Value]:
    """The facts and answers that a recipe says it ends with, by the same names; of several ends that one
    that is meant by what is `found`. Its parts an invariant judges.
    """
    ends = [_by_device(cell, end) for end in cell.recipe(recipe).ends_of(values)]
    return nearest(ends, lambda what, value: what in found and not _alike(value, found[what]))


def _by_device(cell: Cell, end: Mapping[str, Value]) -> dict[str, Value]:
    parts = [(*what.partition("."), value) for what, value in end.items()]
    return {f"{cell.roles[role].name}.{fact}": value for role, dot, fact, value in parts if dot}


def facts_by_report(watched: JudgedWorld, cell: Cell) -> dict[str, object]:
    """The facts of a cell's devices as the plant has heard them last, by the same names."""
    beliefs = beliefs_of(watched.world.plant)
    robots = [robot for robot in cell.robots if robot.name in beliefs]
    return {
        f"{each.name}.{fact}": beliefs[each.name].fact(fact) for each in robots for fact in each.fact_names
    }


def differences(expected: EndState, found: EndState, reported: EndState) -> tuple[str, ...]:
    """Sentences on what is expected and is not so, and on whether the plant has heard of it.

    What nobody could know is passed over.
    """
    return tuple(
        f"{what} is {_shown(found[what])}, not {_shown(value)}{_known(what, found[what], reported)}"
        for what, value in expected.items()
        if what in found and not _alike(value, found[what])
    )


def _parts(watched: JudgedWorld, cell: Cell) -> Iterator[tuple[str, object]]:
    """The numbers of parts, but for those that a person brought or took out: the plant was told of that."""
    truth = watched.truth
    places = truth.places.cells.get(cell.name)
    if places is not None and not places.is_doubtful:
        yield from ((f"parts at {target}", parts) for target, parts in places.as_left.items())
    for robot in cell.robots:
        if robot.name in truth.grips.effectors:
            yield f"parts put down by {robot.name}", truth.grips.effectors[robot.name].put_down


def _known(what: str, value: object, reported: EndState) -> str:
    """Words for whether the plant had been told of a fact as it is; none for what is no fact."""
    if what not in reported:
        return ""
    return KNOWN if _alike(value, reported[what]) else UNKNOWN


def _alike(one: object, other: object) -> bool:
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(_alike, one, other))
    if isinstance(one, float) and isinstance(other, int | float):
        return abs(one - other) <= NEAR
    return one == other


def _shown(value: object) -> str:
    if isinstance(value, tuple):
        return f"({', '.join(f'{each:.3f}' for each in value)})"
    return shown(value) if isinstance(value, bool | int | float | str) else str(value)
