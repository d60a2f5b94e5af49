"""The storage stations of a cell, by number or by rule, and the poses of its palletizing."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import product

from arboleda.model.counting import counted
from arboleda.model.plant_model import Pose

from .document import Place, shown
from .pickups import Pickups, pickup_names
from .poses import STATION, PoseReader
from .robot_models import TO_SI
from .shapes import PalletizingShape, RackShape

Targets = tuple[str, str]
"""The targets of the arm's own cycle: where it takes a part, and where it puts it."""
MOST = 9  # task texts name stations 0 to 8
NUMBER = re.compile(r"[0-9]+", re.ASCII)


def stations(reader: PoseReader, place: Place, home: Pose | None) -> tuple[Pose, ...]:
    """The rack; empty, with the problems kept, if a station cannot be read."""
    keys = reader.document.keys(place)
    listed = any(NUMBER.fullmatch(key) for key in keys)
    poses = _by_number(reader, place, keys) if listed else _by_rule(reader, place, home)
    return tuple(pose for pose in poses if pose) if all(poses) else ()


def palletizing(
    reader: PoseReader, place: Place, pickup: Pose | None, pickups: Pickups, rack: tuple[Pose, ...]
) -> Targets | None:
    """The named pick and place; without the section the pick-up and the last station."""
    shape = reader.document.read(PalletizingShape, place)
    if pickup is None or not rack:
        return None
    if not reader.document.has(place):
        return "pickup", target_of(rack[-1].name)
    if shape is None:
        return None
    poses = pickup_names(pickup, pickups) | {pose.name: pose for pose in rack}
    pick = _named(reader, shape.pick, poses, (*place, "pick"))
    target = _named(reader, shape.place, poses, (*place, "place"))
    if pick is None or target is None:
        return None
    if poses[pick] is poses[target]:
        reader.problem((*place, "place"), "must be another pose than pick")
    return target_of(pick), target_of(target)


def _by_number(reader: PoseReader, place: Place, keys: tuple[str, ...]) -> list[Pose | None]:
    numbers = [str(number) for number in range(min(len(keys), MOST))]
    for key in keys:
        if key not in numbers:
            rule = f"stations are numbered 0, 1, 2, ... without a gap, at most {MOST}"
            reader.problem((*place, key), f"is not a station here; {rule}", at=(*place, key))
    return [
        reader.pose((*place, number), STATION(number=number)) if number in keys else None
        for number in numbers
    ]


def _by_rule(reader: PoseReader, place: Place, home: Pose | None) -> list[Pose | None]:
    """The stations row by row: q1 by its column, q2 by its row; none, with the problem kept, if it fails."""
    shape = reader.document.read(RackShape, place)
    if shape is None or home is None or not _has_columns_and_rows(reader, place):
        return []
    heights = reader.heights(place, needed=False)
    if heights is None:
        return []
    columns, rows = list(enumerate(shape.columns_q1_deg)), list(enumerate(shape.rows_q2_deg))
    if len(columns) * len(rows) > MOST:
        size = f"{counted(len(rows), 'row')} x {counted(len(columns), 'column')}"
        reader.problem(place, f"{size} are more than {MOST} stations")
        return []
    values, places = _from_q3(reader, place, home, heights)
    poses: list[Pose | None] = []
    for number, ((row, q2_deg), (column, q1_deg)) in enumerate(product(rows, columns)):
        q = (TO_SI["deg"](q1_deg), TO_SI["deg"](q2_deg), *values)
        in_file = ((*place, "columns_q1_deg", column), (*place, "rows_q2_deg", row), *places)
        pose = reader.checked(STATION(number=number), q, in_file)
        poses.append(reader.lifted(pose, shape.approach_mm, place) if pose else None)
    return poses


def _from_q3(
    reader: PoseReader, place: Place, home: Pose, heights: Sequence[float]
) -> tuple[list[float], list[Place]]:
    """The values of the joints from q3 on, which all stations share, and the place of each in the file.

    A sliding joint has its height of `mm`, where the rack gives one. Every other joint stands as in `home`.
    """
    given, places_of_mm = iter(heights), reader.places_of_mm(place)
    values, places = [], []
    for joint, at_home in zip(reader.joints[2:], home.joints[2:], strict=True):
        slides = joint.unit == "m"
        values.append(next(given, at_home) if slides else at_home)
        places.append(next(places_of_mm) if slides else place)
    return values, places


def _has_columns_and_rows(reader: PoseReader, place: Place) -> bool:
    turns = [joint.unit == "rad" for joint in reader.joints[:2]] == [True, True]
    if not turns:
        rule = f"a rack by rule needs q1 and q2 that turn, and the {reader.model} has not"
        reader.problem(place, f"{rule}; write the stations one by one: 0, 1, ...")
    return turns


def target_of(name: str) -> str:
    """The target for a name of the short form: `station_7` for `station 7`."""
    return name.replace(" ", "_")


def _named(reader: PoseReader, text: str, poses: dict[str, Pose], place: Place) -> str | None:
    """The name of a pose as its text spells it; None, with the problem kept, if it is none."""
    name = " ".join(text.lower().split())
    if name not in poses:
        pickups = ", ".join(f'"{name}"' for name in poses if name.startswith("pickup"))
        allowed = f'{pickups}, or "station 0" to "{list(poses)[-1]}"'
        reader.problem(place, f"must be {allowed}, is {shown(text)}")
        return None
    return name
