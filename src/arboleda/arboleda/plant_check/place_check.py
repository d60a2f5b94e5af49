"""Check of places: devices without a place for their parts, and places where others get in the way."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import combinations

from arboleda.geometry import bodies, kinematics
from arboleda.kinds.arm import Arm
from arboleda.kinds.declared import Effect
from arboleda.model.common_places import same_places
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import Cell, Place, PlantModel, Pose, Robot
from arboleda.plant_file.declared_kinds import verbs_of
from arboleda.plant_file.urdf import drawn_arm, robot_urdf
from arboleda.plant_file.yaml_flow import flow

BASE = f"base: {flow({'origin_m': ['x', 'y']})}"
APART_M = 0.030  # so far apart two tools may be at one place; a part is hardly smaller


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """A sentence for each unguarded place, each device without a place, and each place that is two."""
    placed = frozenset(place.device for cell in plant.cells for place in cell.places)
    rows = ((*_unguarded(cell), *_without_place(cell, placed), *_forgotten(cell)) for cell in plant.cells)
    unsaid = [*(sentence for row in rows for sentence in row), *_said_differently(plant)]
    try:
        return (*unsaid, *(each for cell in plant.cells for each in _split(plant, cell)))
    except ArboledaError:  # `meeting_points` names the reason
        return tuple(unsaid)


def _unguarded(cell: Cell) -> Iterator[str]:
    """The places at devices that move there, while nothing keeps robots out."""
    for place in cell.places:
        device = next((each for each in cell.robots if each.name == place.device), None)
        moves = _moves(device)
        reaching = [space.robot.name for space in cell.spaces if place.target in space.targets]
        if device is None or not (moves and reaching) or _is_guarded(cell, place):
            continue
        place_text = f"{cell.name}: {place.target} is at {device.name}, which moves ({', '.join(moves)})"
        how = "a zone with this target and free_while or held_while of the device does"
        yield f"{place_text}, and nothing keeps {' and '.join(reaching)} out of there meanwhile; {how}"


def _moves(device: Robot | None) -> list[str]:
    """The verbs with which something of a device moves."""
    verbs = {} if device is None else verbs_of(device)
    return [name for name, verb in verbs.items() if verb.effect is Effect.MOTION]


def _is_guarded(cell: Cell, place: Place) -> bool:
    zones = {each.zone for each in cell.interlocks if each.device == place.device}
    poses = [space.targets[place.target] for space in cell.spaces if place.target in space.targets]
    robots = {name for space in cell.spaces for name in (space.robot.name, space.hand.name)}
    needed = any(each.device in robots and each.other == place.device for each in cell.needs)
    return needed or all(pose.zones & zones for pose in poses)


def _without_place(cell: Cell, placed: frozenset[str | None]) -> Iterator[str]:
    """The devices that work on parts and have no place, so that nobody knows whether a part is there.

    A shared device may be `placed` in another cell.
    """
    placed_somewhere = placed | {space.hand.name for space in cell.spaces}
    for role, device in cell.members:
        if device.name in placed_somewhere:
            continue
        verbs = verbs_of(device).items()
        works = [f"works on a part ({name})" for name, verb in verbs if verb.works_on_part]
        works += [f"makes a part ({name})" for name, verb in verbs if verb.makes_part]
        holds = [f"takes hold of a part ({name})" for name, verb in verbs if verb.holds and cell.places]
        for what in [*works, *holds][:1]:
            how = f"places: {{TARGET: {{of: {role}}}}}" + ("" if works else ", or tool_of")
            yield f"{cell.name}: {device.name} {what}, and no place is of it; say where: {how}"


def _said_differently(plant: PlantModel) -> Iterator[str]:
    """The places of several cells, at which their shared robot stands alike, that cannot be as all say."""
    for group in _common(plant):
        if _contradict([place for _, place in group]):
            words = dict[str, list[str]]()
            for cell, place in group:
                words.setdefault(_words(place), []).append(cell.name)
            said = ", ".join(f"{text} ({', '.join(cells)})" for text, cells in words.items())
            cells = ", ".join(cell.name for cell, _ in group)
            target = group[0][1].target
            yield f"{cells}: {target} is one place of these cells, and is {said}; write the same in each"


def _common(plant: PlantModel) -> list[list[tuple[Cell, Place]]]:
    """The places of all cells; those that are one place are together."""
    groups: list[list[tuple[Cell, Place]]] = []
    for cell in plant.cells:
        for place in cell.places:
            for group in groups:
                first, its = group[0]
                if place.target in same_places(first, its.target, cell):
                    group.append((cell, place))
                    break
            else:
                groups.append([(cell, place)])
    return groups


def _contradict(places: Sequence[Place]) -> bool:
    """True where places that are one have different room or devices, or are filled and emptied by people."""
    devices = {place.device for place in places if place.device is not None}
    people = {"supply" for each in places if each.supply} | {"output" for each in places if each.output}
    return len({place.holds for place in places}) > 1 or len(devices) > 1 or len(people) > 1


def _words(place: Place) -> str:
    """The words of a plant file about a place."""
    given = {"holds": place.holds, "of": place.device, "supply": place.supply, "output": place.output}
    return flow({key: value for key, value in given.items() if value})


def _forgotten(cell: Cell) -> Iterator[str]:
    """The outputs in devices that hold parts: one that a task leaves there is forgotten by the next one.

    A device that holds none, as a conveyor, may carry it away.
    """
    holders = {robot.name for robot in cell.robots if robot.held_fact is not None}
    for place in cell.places:
        if place.output and place.device in holders:
            yield (
                f"{cell.name}: {place.target} is inside {place.device}, and an output, so it counts as empty"
                " when a task begins, whoever has looked; leave out `output`, and say unload once it is empty"
            )


def _split(plant: PlantModel, cell: Cell) -> Iterator[str]:
    """The places at which two arms go to positions that are far from each other."""
    arms = [(arm, space.targets) for space in cell.spaces if (arm := drawn_arm(space.robot)) is not None]
    for (one, its), (other, others) in combinations(arms, 2):
        for place in cell.places:
            if place.target in its and place.target in others:
                at = (_tool(plant, one, its[place.target]), _tool(plant, other, others[place.target]))
                apart = math.dist(*at)
                if apart > APART_M and one.base != other.base:
                    names, mm = f"{one.name} and {other.name}", f"{apart * 1000:.0f} mm"
                    split = f"{cell.name}: {place.target} is one place, and {names} go {mm} apart"
                    yield f"{split}; correct a target, or write {BASE}"


def _tool(plant: PlantModel, arm: Arm, target: Pose) -> Sequence[float]:
    """The position of an arm's tool at a target, in plan."""
    frame = kinematics.floor((arm.base.x, arm.base.y, arm.base.yaw))
    body = bodies.read(robot_urdf(plant, arm.name))
    return kinematics.at(kinematics.tool(body, target.joints, frame))[:2]
