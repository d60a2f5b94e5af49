"""Rules that a plant file could state, and does not: of parts, of devices in a zone, of needs of work.

Nobody can judge a rule that is not stated. Recipes show where a rule matters. A recipe may be wrong, so each
value of a fact is offered, and a person takes the right one.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.engine import Act, Plant
from arboleda.kinds.declared import Effect
from arboleda.model.commands import Motion, Switch
from arboleda.model.facts import Value
from arboleda.model.orders import orders
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.plant_file.declared_kinds import verbs_of
from arboleda.plant_file.document import Place
from arboleda.plant_file.draft import Unstated
from arboleda.recipes.authoring import WrittenRecipe
from arboleda.recipes.of_files import FileRecipe

from .walkthrough import in_order

FactValues = dict[tuple[str, str], Value]
HOME = "home"
MOST_ORDERS = 20  # tasks of a recipe that are looked at


def unstated(plant: PlantModel) -> tuple[Unstated, ...]:
    """All rules that could be stated of the cells whose recipes are the plant's own."""
    runs, by_place = Plant(plant, epoch=0, now=0.0).cells, dict[Place, Unstated]()
    for cell in (each for each in plant.cells if each.handover is None):
        seen = _Seen(cell=cell)
        for recipe in (each for each in cell.recipes if isinstance(each, FileRecipe | WrittenRecipe)):
            for order, _ in zip(orders(cell, recipe), range(MOST_ORDERS), strict=False):
                seen.follow(recipe.build(order, runs[cell.name].context).children[0])
        for each in (*_places(seen), *_guards(plant, seen), *_needs(seen)):
            by_place.setdefault(each.place, each)
    return tuple(by_place.values())


def notes(plant: PlantModel) -> tuple[str, ...]:
    """A sentence for each rule that could be stated, with the text that would state it."""
    return tuple(each.offer for each in unstated(plant))


def unknowns(plant: PlantModel) -> tuple[str, ...]:
    """A sentence for each rule that could be stated, for the answer of a judge of the plant."""
    return tuple(each.unknown for each in unstated(plant))


@dataclass(kw_only=True)
class _Seen:
    """Acts of the tasks of a cell in the order of their steps. Of alternatives, all count as done."""

    cell: Cell
    taken: set[str] = field(default_factory=set)  # targets
    put: set[str] = field(default_factory=set)
    entered: dict[tuple[str, str], list[FactValues]] = field(default_factory=dict)  # by robot and target
    called: dict[tuple[str, str], list[FactValues]] = field(default_factory=dict)  # by device and verb

    def follow(self, tree: Behaviour) -> None:
        at, facts = dict[str, str](), FactValues()
        hands = {space.hand.name: space.robot.name for space in self.cell.spaces if space.hand.held_fact}
        for command in (node.make(id="") for node in in_order(tree) if isinstance(node, Act)):
            if isinstance(command, Motion) and command.robot in self.cell.reach:
                poses = self.cell.reach[command.robot].targets
                goal = next((name for name, pose in poses.items() if pose.q in command.way[-1:]), None)
                if goal is not None:
                    at[command.robot] = goal
                    self.entered.setdefault((command.robot, goal), []).append(dict(facts))
            elif isinstance(command, Switch) and command.grips is not None and command.robot in hands:
                target = at.get(hands[command.robot])
                if target is not None:
                    (self.taken if command.grips else self.put).add(target)
            self.called.setdefault((command.robot, command.word), []).append(dict(facts))
            facts |= {(command.robot, fact): value for fact, value in command.sets}

    def doors(
        self, times: Sequence[FactValues], roles: Collection[str]
    ) -> Iterator[tuple[str, str, list[Value]]]:
        """The facts of moving parts of devices that recipes had brought to one value each time.

        Each has the role of its device and all values of the fact, that of the recipes first.
        """
        sure = set.intersection(*(set(each.items()) for each in times)) if times else set[Any]()
        for role, device in self.cell.members:
            for (name, fact), value in sorted(sure, key=str):
                values = _moved(self.cell, name).get(fact, [])
                if role in roles and device.name == name and len(values) > 1 and value in values:
                    yield role, fact, [value, *(each for each in values if each != value)]


def _places(seen: _Seen) -> Iterator[Unstated]:
    """The targets at which parts are taken and put down, where the cell has no place at all."""
    cell, targets = seen.cell, sorted((seen.taken | seen.put) - {HOME})
    if cell.places or not targets:
        return
    value = {each: _keys_of_place(is_taken=each in seen.taken, is_put=each in seen.put) for each in targets}
    unknown = f"{cell.name}: nothing is known of where parts lie"
    yield Unstated(unknown=unknown, place=("cells", cell.name, "places"), values=(value,))


def _keys_of_place(*, is_taken: bool, is_put: bool) -> dict[str, bool]:
    """The keys of a place. People fill a place from which parts are only taken, and empty the opposite."""
    return {} if is_taken and is_put else {"supply": True} if is_taken else {"output": True}


def _guards(plant: PlantModel, seen: _Seen) -> Iterator[Unstated]:
    """The zones that only one robot enters, and no device: such a zone keeps nobody out."""
    roles = [role for role, _ in seen.cell.members]
    for zone in plant.zones:
        inside = [space for cell in plant.cells for space in cell.spaces if zone in space.zones]
        devices = [lock for cell in plant.cells for lock in cell.interlocks if lock.zone == zone]
        if devices or len({space.robot.name for space in inside}) != 1 or inside[0] not in seen.cell.spaces:
            continue
        robot = inside[0].robot.name
        targets = [name for name, pose in inside[0].targets.items() if zone in pose.zones]
        times = [facts for name in targets for facts in seen.entered.get((robot, name), [])]
        for role, fact, values in seen.doors(times, roles):
            unknown = f"{seen.cell.name}: nothing is known of who else is in the zone {zone} of {robot}"
            choice_of = tuple({role: {fact: value}} for value in values)
            yield Unstated(unknown=unknown, place=("zones", zone, "free_while"), values=choice_of)


def _needs(seen: _Seen) -> Iterator[Unstated]:
    """The work of devices of which nobody says what it needs, and whose part recipes move before it."""
    cell = seen.cell
    for role, device in cell.members:
        stated = {each.word for each in cell.needs if each.device == device.name}
        for name, verb in verbs_of(device).items():
            if verb.effect is not Effect.PROCESS or verb.says_needs or name in stated:
                continue
            for _, fact, values in seen.doors(seen.called.get((device.name, name), []), [role]):
                unknown = f"{cell.name}: nothing is known of what {name} of {device.name} needs"
                place = ("kinds", device.kind_name, "verbs", name, "needs")
                yield Unstated(unknown=unknown, place=place, values=(*({fact: each} for each in values), {}))


def _moved(cell: Cell, name: str) -> dict[str, list[Value]]:
    """The values that the moves of a device set, by fact."""
    device = next(each for each in cell.robots if each.name == name)
    by_fact: dict[str, list[Value]] = {}
    for verb in (each for each in verbs_of(device).values() if each.effect is Effect.MOTION):
        for fact, value in verb.sets:
            if isinstance(value, str | bool) and value not in by_fact.setdefault(fact, []):
                by_fact[fact].append(value)
    return by_fact
