"""Candidates in a plant file: a zone that is missing, a fact that no verb sets.

What devices need, and while what zones are free, is never changed: these are the rules of whoever built the
cell, and a recipe is mended by keeping them.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from typing import Any

from arboleda.drivers import Effect, Value, shown
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.plant_check.mend import cut_between
from arboleda.plant_file import yaml_edit
from arboleda.plant_file.document import Place
from arboleda.plant_file.yaml_edit import EditRefused
from arboleda.plant_file.yaml_marks import YamlFault, YamlNode, parse

from .candidate import Candidate
from .clues import Clues

SURE = 20  # before all that is only likely
KEEPS_OUT, CAN_MEET = "nothing keeps", "can meet at"


def plant_candidates(file: str, text: str, model: PlantModel | None, clues: Clues) -> Iterator[Candidate]:
    """The candidates in a plant file."""
    try:
        root, _ = parse(text.encode())
    except YamlFault:
        return
    if model is not None:
        if clues.says(KEEPS_OUT, CAN_MEET):
            yield from _zones(file, text, root, model, clues)
        yield from _sets(file, text, root, model, clues)


def _set(file: str, text: str, place: Place, value: Any, sentence: str, score: float) -> Iterator[Candidate]:
    with suppress(EditRefused):
        changed = yaml_edit.with_value(text.encode(), place, value).decode()
        yield Candidate(cuts=(cut_between(file, text, changed),), sentence=sentence, score=score)


def _zones(file: str, text: str, root: YamlNode, model: PlantModel, clues: Clues) -> Iterator[Candidate]:
    zones = root.children.get("zones")
    there = dict(zones.value) if zones is not None else {}
    for cell in model.cells:
        targets = sorted({name for space in cell.spaces for name in space.targets if name != "home"})
        for target in [each for each in targets if each in clues.names and cell.name in clues.text]:
            pose = f"{cell.name} {target}"
            frees = [{}, *_free(cell, clues)] if clues.says(CAN_MEET) else _free(cell, clues)
            for rank, free in enumerate(frees):
                yield from _zone(file, text, there, pose, free, 7 + 2 * bool(free) - rank / 10)


def _free(cell: Cell, clues: Clues) -> list[dict[str, Any]]:
    """The facts, by role, of devices that move, at which a robot may be there."""
    found: list[dict[str, Any]] = []
    for role, robot in cell.members:
        device: Any = robot
        if device.verb_names:
            moving = [each for each in device.kind.verbs.values() if each.effect is Effect.MOTION]
            sets = sorted({each for verb in moving for each in verb.sets}, key=str)
            near = device.name in clues.names or role in clues.names
            rows = [{role: {fact: value}} for fact, value in sets if isinstance(value, str | bool)]
            found = [*rows, *found] if near else found
    return found


def _words(facts: dict[str, Value]) -> str:
    return ", ".join(f"{fact} {shown(value)}" for fact, value in facts.items())


def _zone(
    file: str, text: str, there: dict[str, Any], pose: str, free: dict[str, Any], score: float
) -> Iterator[Candidate]:
    name = next((key for key, zone in there.items() if pose in zone.get("poses", ())), None)
    words = " and ".join(f"free while {role} says {_words(fact)}" for role, fact in free.items())
    words = words or "for one at a time"
    if name is None:
        fresh = f"at_{pose.replace(' ', '_')}"
        value = {"poses": [pose], **({"free_while": free} if free else {})}
        yield from _set(file, text, ("zones", fresh), value, f"a zone {fresh} {words}", score)
    elif free and "free_while" not in there[name]:
        place = ("zones", name, "free_while")
        yield from _set(file, text, place, free, f"zone {name} {words}", score)


def _sets(file: str, text: str, root: YamlNode, model: PlantModel, clues: Clues) -> Iterator[Candidate]:
    """Facts that two verbs of a kind set alike, while no verb sets what findings miss."""
    kinds = {device.kind.name: device.kind for device in _devices(model)}
    for kind in kinds.values():
        known: dict[str, list[Value]] = {}
        for verb in kind.verbs.values():
            for fact, value in verb.sets:
                known.setdefault(fact, []).append(value)
        for fact, values in known.items():
            missing = [each for each in kind.facts[fact].words if each not in values]
            if fact not in clues.names or len(missing) != 1 or len(set(values)) == len(values):
                continue
            for verb in kind.verbs.values():
                place: Place = ("kinds", kind.name, "verbs", verb.name, "sets", fact)
                if dict(verb.sets).get(fact) in values and _has(root, place):
                    words = f"{verb.name} of {kind.name} sets {fact} {shown(missing[0])}, which no verb does"
                    yield from _set(file, text, place, missing[0], words, SURE)


def _devices(model: PlantModel) -> Iterator[Any]:
    yield from (robot for robot in model.robots.values() if robot.verb_names)


def _has(root: YamlNode, place: Place) -> bool:
    node: YamlNode | None = root
    for key in place:
        node = None if node is None else node.children.get(key)
    return node is not None
