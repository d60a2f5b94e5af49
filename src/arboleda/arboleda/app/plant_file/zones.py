"""The regions that robots share: which poses lie in them and which moves cross them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from arboleda.core.model import Crossing, Pose
from arboleda.recipes.storage import plan_problems
from arboleda.recipes.storage_cell import StorageCell

from .alike import confusions, with_alike_crossings
from .document import Document, Place, nearest, shown
from .pickups import pickup_names
from .shapes import MAPPING, NAME_RULE, ZoneShape, is_name

SECTION: Place = ("zones",)
T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class Spot:
    """One pose of one cell, both by the names they have in the plant model."""

    cell: str
    pose: str


@dataclass(frozen=True, kw_only=True)
class Zone:
    """What a zone covers, each with its position in its list; a move is the set of its two ends."""

    name: str
    poses: dict[Spot, int]
    moves: dict[frozenset[Spot], int]

    def place(self, *spots: Spot) -> Place:
        """Where the file names this pose, or the move between these two; it may not name that itself."""
        if len(spots) > 1:
            place: Place = (*SECTION, self.name, "moves")
            number = self.moves.get(frozenset(spots))
            return place if number is None else (*place, number)
        return (*SECTION, self.name, "poses", self.poses[spots[0]])


def zones(document: Document, cells: Sequence[StorageCell]) -> tuple[Zone, ...]:
    """Every zone of the file; parts that are wrong are left out, with the problems kept.

    `cells` are those that could be read; poses of the others are not looked at.
    """
    if not document.has(SECTION):
        return ()
    document.read_plain(MAPPING, SECTION)
    return tuple(_zone(document, name, cells) for name in document.keys(SECTION))


def with_zones(document: Document, cell: StorageCell, all_zones: Sequence[Zone]) -> StorageCell:
    """The cell with the zones of its poses and moves; a problem is kept where no way can be planned."""

    def placed(pose: Pose) -> Pose:
        spot = Spot(cell=cell.name, pose=pose.name)
        return replace(pose, zones=frozenset(zone.name for zone in all_zones if spot in zone.poses))

    palletizing = replace(
        cell.palletizing, pick=placed(cell.palletizing.pick), place=placed(cell.palletizing.place)
    )
    zoned = replace(
        cell,
        home=placed(cell.home),
        pickup=placed(cell.pickup),
        pickups=tuple((exit, placed(pose)) for exit, pose in cell.pickups),
        stations=tuple(placed(pose) for pose in cell.stations),
        palletizing=palletizing,
        crossings=_crossings(cell, all_zones),
    )
    zoned = with_alike_crossings(zoned) if zoned.zones else zoned
    unplanned = plan_problems(zoned)
    for pose, sentence in unplanned.items():
        spot = Spot(cell=cell.name, pose=pose)
        zone = next(zone for zone in all_zones if spot in zone.poses)
        document.problem(zone.place(spot), sentence)
    for found in confusions(zoned) if zoned.zones and not unplanned else ():
        zone = next(zone for zone in all_zones if zone.name == found.zone)
        spots = [Spot(cell=cell.name, pose=name) for name in found.named]
        document.problem(zone.place(*spots), f"cell {cell.name}: {found.sentence}")
    return zoned


def _zone(document: Document, name: str, cells: Sequence[StorageCell]) -> Zone:
    place: Place = (*SECTION, name)
    if not is_name(name):
        document.problem(place, f"a zone's name must be {NAME_RULE}", at=place)
    shape = document.read(ZoneShape, place)
    if shape is None:
        return Zone(name=name, poses={}, moves={})
    if not (shape.poses or shape.moves):
        document.problem(place, "a zone has poses, moves or both; this one is empty")
    listed = _spots(document, (*place, "poses"), shape.poses, cells)
    poses = _once(document, (*place, "poses"), listed, "the pose is there twice")
    ends = [_spots(document, (*place, "moves", i), pair, cells) for i, pair in enumerate(shape.moves)]
    moves = [_move(document, (*place, "moves", i), pair, poses) for i, pair in enumerate(ends)]
    twice = "the move is there twice; a direction makes no difference"
    return Zone(name=name, poses=poses, moves=_once(document, (*place, "moves"), moves, twice))


def _spots(
    document: Document, place: Place, texts: list[str], cells: Sequence[StorageCell]
) -> list[Spot | None]:
    return [_spot(document, (*place, index), text, cells) for index, text in enumerate(texts)]


def _spot(document: Document, place: Place, text: str, cells: Sequence[StorageCell]) -> Spot | None:
    """`sis_a pickup` -> its spot; None where it is none, or where its cell could not be read."""
    name, *words = text.lower().split() or [""]
    names = document.keys(("cells",))
    if name not in names:
        example = f'must be a cell and one of its poses, as "{names[0] if names else "sis_a"} pickup"'
        hint = nearest(name, names)
        document.problem(place, f"{example}, is {shown(text)}; there is no cell {shown(name)}{hint}")
        return None
    cell = next((cell for cell in cells if cell.name == name), None)
    if document.has(("cells", name, "devices")):
        document.problem(place, f"{name} is a cell of devices; zones are not possible for it yet")
    if cell is None:
        return None
    poses, pose = _poses(cell), " ".join(words)
    if pose not in poses:
        stations = f'"station 0" to "station {len(cell.stations) - 1}"'
        pickups = ", ".join(f'"{word}"' for word in pickup_names(cell.pickup, cell.pickups))
        known = f'poses of {name} are "home", {pickups} and {stations}'
        document.problem(place, f"{known}, is {shown(text)}{nearest(pose, poses)}")
        return None
    return Spot(cell=name, pose=poses[pose].name)


def _poses(cell: StorageCell) -> dict[str, Pose]:
    """The poses of a cell by the names they have in a plant file."""
    pickups = pickup_names(cell.pickup, cell.pickups)
    return {"home": cell.home} | pickups | {pose.name: pose for pose in cell.stations}


def _move(
    document: Document, place: Place, ends: Sequence[Spot | None], inside: Collection[Spot | None]
) -> frozenset[Spot] | None:
    """The move between two ends; None, with the problem kept, where it cannot cross a zone with `inside`."""
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
    """The values that are there, with their first positions; keeps a problem for each that is repeated."""
    found: dict[T, int] = {}
    for index, value in enumerate(values):
        if value is not None and value in found:
            document.problem((*place, index), sentence)
        elif value is not None:
            found[value] = index
    return found


def _crossings(cell: StorageCell, all_zones: Sequence[Zone]) -> tuple[Crossing, ...]:
    """One crossing for each pair of poses, with all the zones that lie between them."""
    crossed: dict[tuple[str, ...], set[str]] = {}
    for zone in all_zones:
        for move in zone.moves:
            if all(end.cell == cell.name for end in move):
                crossed.setdefault(tuple(sorted(end.pose for end in move)), set()).add(zone.name)
    return tuple(Crossing(a=a, b=b, zones=frozenset(names)) for (a, b), names in crossed.items())
