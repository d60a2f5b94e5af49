"""Zones that robots share: the poses in them, and the moves that cross them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from arboleda.kinds.declared import UseError
from arboleda.model import zone_plan
from arboleda.model.facts import Value
from arboleda.model.plant_model import Cell, Crossing, Interlock, Pose, Robot, Workspace

from .document import Document, Place, choice, misnamed, nearest, shown
from .pose_confusion import alike_crossings, confusions
from .shapes import MAPPING, NAME_RULE, WORDS, ZoneShape, is_name
from .storage_form import plan_problems

SECTION: Place = ("zones",)
WAITS = "robots wait there, so it must be outside all zones"
T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class PoseOfCell:
    """One pose of one cell, both by the names they have in the plant model."""

    cell: str
    pose: str


@dataclass(frozen=True, kw_only=True)
class Zone:
    """Poses and moves of a zone, each with its index in the file; a move is the set of its two ends."""

    name: str
    poses: dict[PoseOfCell, int]
    moves: dict[frozenset[PoseOfCell], int]
    interlocks: tuple[Interlock, ...] = ()

    def place(self, *spots: PoseOfCell) -> Place:
        """The place in the file of this pose, or of the move between two; `moves` if it has no row."""
        if len(spots) > 1:
            place: Place = (*SECTION, self.name, "moves")
            number = self.moves.get(frozenset(spots))
            return place if number is None else (*place, number)
        return (*SECTION, self.name, "poses", self.poses[spots[0]])


def zones(document: Document, cells: Sequence[Cell]) -> tuple[Zone, ...]:
    """Every zone of the file; wrong poses and moves are left out, with the problems kept.

    `cells` are the cells that could be read; poses of other cells are not checked.
    """
    if not document.has(SECTION):
        return ()
    document.read_plain(MAPPING, SECTION)
    return tuple(_zone(document, name, cells) for name in document.keys(SECTION))


def with_zones(document: Document, cell: Cell, all_zones: Sequence[Zone]) -> Cell:
    """The cell with the zones of its targets, and the devices that occupy zones by themselves.

    Poses of a robot with paths lie in no zone: nobody plans which zones its paths cross.
    """
    spaces = []
    for space in cell.spaces:
        if space.paths:
            spaces.append(space)
            continue
        poses = tuple(_placed(cell, pose, all_zones) for pose in space.poses)
        names = {pose.name for pose in poses}
        crossings = tuple(each for each in _crossings(cell, all_zones) if {each.a, each.b} <= names)
        home = next(pose for pose in poses if pose.name == space.home.name)
        zoned = replace(space, home=home, poses=poses, crossings=crossings)
        zoned = replace(zoned, crossings=alike_crossings(zoned)) if zoned.zones else zoned
        if not home.zones:
            _keep_confusions(document, cell, zoned, all_zones)
        spaces.append(zoned)
    zoned_cell = replace(cell, spaces=tuple(spaces))
    homes = [space.home for space in spaces if space.home.zones]
    lying = {home.name: f"in cell {cell.name}: {zone_plan.lying(home)}; {WAITS}" for home in homes}
    _keep_unplanned(document, cell, lying | plan_problems(zoned_cell), all_zones)
    locks = tuple(
        lock for zone in all_zones for lock in zone.interlocks if lock.device in _device_names(cell)
    )
    return replace(zoned_cell, interlocks=locks)


def _device_names(cell: Cell) -> set[str]:
    return {device.name for device in cell.robots}


def _keep_unplanned(
    document: Document, cell: Cell, unplanned: Mapping[str, str], all_zones: Sequence[Zone]
) -> None:
    """Keep a problem for each pose through which no path can be planned; `unplanned` has the sentences."""
    for pose, sentence in unplanned.items():
        spot = PoseOfCell(cell=cell.name, pose=pose)
        zone = next(zone for zone in all_zones if spot in zone.poses)
        document.problem(zone.place(spot), sentence)


def _keep_confusions(document: Document, cell: Cell, space: Workspace, all_zones: Sequence[Zone]) -> None:
    """Keep a problem for each zone in which a robot might be although it counts as outside."""
    for confusion in confusions(space) if space.zones else ():
        zone = next(zone for zone in all_zones if zone.name == confusion.zone)
        spots = [PoseOfCell(cell=cell.name, pose=name) for name in confusion.named]
        document.problem(zone.place(*spots), f"in cell {cell.name}: {confusion.sentence}")


def _placed(cell: Cell, pose: Pose, all_zones: Sequence[Zone]) -> Pose:
    spot = PoseOfCell(cell=cell.name, pose=pose.name)
    return replace(pose, zones=frozenset(zone.name for zone in all_zones if spot in zone.poses))


def _zone(document: Document, name: str, cells: Sequence[Cell]) -> Zone:
    place: Place = (*SECTION, name)
    if not is_name(name):
        document.problem(place, f"a zone's name must be {NAME_RULE}", at=place)
    shape = document.read(ZoneShape, place)
    if shape is None:
        return Zone(name=name, poses={}, moves={})
    interlocks = _interlocks(document, place, cells)
    if not (shape.poses or shape.moves) and len(shape.free_while.keys() | shape.held_while.keys()) < 2:
        document.problem(
            place, "a zone has poses, moves, or two devices that may be in it; this one is empty"
        )
    listed = _spots(document, (*place, "poses"), shape.poses, cells)
    poses = _once(document, (*place, "poses"), listed, "the pose is there twice")
    ends = [_spots(document, (*place, "moves", i), pair, cells) for i, pair in enumerate(shape.moves)]
    moves = [_move(document, (*place, "moves", i), pair, poses) for i, pair in enumerate(ends)]
    twice = "the move is there twice; a direction makes no difference"
    return Zone(
        name=name,
        poses=poses,
        moves=_once(document, (*place, "moves"), moves, twice),
        interlocks=interlocks,
    )


def _interlocks(document: Document, place: Place, cells: Sequence[Cell]) -> tuple[Interlock, ...]:
    """The devices that occupy a zone by themselves, each with the facts or verbs by which it does."""
    robots = {device.name: device for cell in cells for device in cell.robots}
    free = _of_devices(document, (*place, "free_while"), robots, _facts)
    held = _of_devices(document, (*place, "held_while"), robots, _verbs)
    return tuple(
        Interlock(
            device=name,
            zone=str(place[-1]),
            free_while=free.get(name, ()),
            held_while=frozenset(held.get(name, ())),
        )
        for name in dict.fromkeys((*free, *held))
    )


def _of_devices(
    document: Document,
    place: Place,
    robots: Mapping[str, Robot],
    read: Callable[[Document, Place, Any], tuple[T, ...]],
) -> dict[str, tuple[T, ...]]:
    """The values of a mapping by the names of devices; problems of wrong names are kept."""
    values = {}
    devices = {name: robot for name, robot in robots.items() if robot.verb_names}
    for name in document.keys(place):
        if name in devices:
            values[name] = read(document, (*place, name), devices[name])
        elif name in robots or name not in _named_devices(document):  # else reported at the device
            sentence = misnamed(name, devices, "there is no declared device")
            document.problem(place, sentence, at=(*place, name))
    return values


def _facts(document: Document, place: Place, device: Any) -> tuple[tuple[str, Value], ...]:
    facts = document.read_plain(MAPPING, place) or {}
    for fact, value in facts.items():
        try:
            device.kind.check_fact(fact, value)
        except UseError as error:
            document.problem((*place, fact), str(error))
    return tuple(facts.items())


def _verbs(document: Document, place: Place, device: Any) -> tuple[str, ...]:
    verbs = document.read_plain(WORDS, place) or []
    for index, verb in enumerate(verbs):
        if verb not in device.verb_names:
            document.problem((*place, index), misnamed(verb, device.verb_names, ""))
    return tuple(verbs)


def _named_devices(document: Document) -> list[str]:
    """The names of all devices in the file, right or wrong."""
    cells: list[Place] = [("cells", name, "devices") for name in document.keys(("cells",))]
    cells.append(("shared",))
    places = [(*cell, role) for cell in cells for role in document.keys(cell)]
    return [str(document.value((*place, "name")) or place[-1]) for place in places]


def _spots(
    document: Document, place: Place, texts: list[str], cells: Sequence[Cell]
) -> list[PoseOfCell | None]:
    return [_spot(document, (*place, index), text, cells) for index, text in enumerate(texts)]


def _spot(document: Document, place: Place, text: str, cells: Sequence[Cell]) -> PoseOfCell | None:
    """The pose in a text such as `sis_a pickup`; None if there is none, or if its cell could not be read."""
    name, *words = text.lower().split() or [""]
    names = document.keys(("cells",))
    if name not in names:
        example = f'must be a cell and one of its poses, as "{names[0] if names else "sis_a"} pickup"'
        hint = nearest(name, names)
        document.problem(place, f"{example}, is {shown(text)}; there is no cell {shown(name)}{hint}")
        return None
    cell = next((cell for cell in cells if cell.name == name), None)
    if cell is None:
        return None
    poses, pose = _poses(cell), "_".join(words)  # "station 7" and "station_7" are the same target
    if pose not in poses:
        allowed = f"targets of {name} are {choice(poses)}" if poses else f"{name} has no targets"
        document.problem(place, f"{allowed}, is {shown(text)}{nearest(pose, poses)}")
        return None
    return PoseOfCell(cell=name, pose=poses[pose].name)


def _poses(cell: Cell) -> dict[str, Pose]:
    """The poses of a cell that may lie in zones, by the names they have in a plant file."""
    return {name: pose for space in cell.spaces if not space.paths for name, pose in space.targets.items()}


def _move(
    document: Document, place: Place, ends: Sequence[PoseOfCell | None], inside: Collection[PoseOfCell | None]
) -> frozenset[PoseOfCell] | None:
    """The move between two ends; None, with the problem kept, if it cannot cross a zone with these poses."""
    a, b = ends
    if a is None or b is None:
        return None
    if a.cell != b.cell:
        document.problem(place, f"the ends of a move are of one cell; these are of {a.cell} and {b.cell}")
    elif a == b:
        document.problem(place, "the two ends of a move differ; these are the same pose")
    elif within := [index for index, end in enumerate(ends) if end in inside]:
        rule = "lies in the zone itself, so each of its moves does; name moves between poses outside"
        document.problem((*place, within[0]), f"this end {rule}")
    else:
        return frozenset({a, b})
    return None


def _once(document: Document, place: Place, values: Iterable[T | None], sentence: str) -> dict[T, int]:
    """The values, with their first positions; keeps a problem for each repeated one."""
    positions: dict[T, int] = {}
    for index, value in enumerate(values):
        if value is not None and value in positions:
            document.problem((*place, index), sentence)
        elif value is not None:
            positions[value] = index
    return positions


def _crossings(cell: Cell, all_zones: Sequence[Zone]) -> tuple[Crossing, ...]:
    """One crossing for each pair of poses, with all the zones that lie between them."""
    crossed: dict[tuple[str, ...], set[str]] = {}
    for zone in all_zones:
        for move in zone.moves:
            if all(end.cell == cell.name for end in move):
                crossed.setdefault(tuple(sorted(end.pose for end in move)), set()).add(zone.name)
    return tuple(Crossing(a=a, b=b, zones=frozenset(names)) for (a, b), names in crossed.items())
