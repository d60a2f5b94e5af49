"""Short form of a cell that stores parts: keys for an arm, a mobile robot, their poses, paths and a rack.

It stands for a cell of devices with paths and a handover. In that cell, the arm and the mobile robot have the
roles `arm` and `mobile`, and targets are called `home`, `pickup`, `pickup_b`, `station_7`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile
from arboleda.model import zone_plan
from arboleda.model.plant_model import STATIONS, Cell, Handover, Pose, Robot, Workspace
from arboleda.model.plant_model import Path as Route
from arboleda.model.recipe import Recipe
from arboleda.model.sentence import OWN
from arboleda.recipes.storage import (
    ARM,
    HOME,
    MOBILE,
    PALLETIZING_TARGETS,
    RECIPES,
    palletizing,
    storage,
)

from . import rack
from .any_cell import check_absence, common_keys
from .document import Document, Place
from .paths import check_nodes_show, exit_of, paths
from .pickups import Pickups, default_pickup, pickups
from .poses import PoseReader
from .robot_models import ArmModel
from .robots import arm, arm_model, mobile
from .shapes import CellShape, PoseShape, PositionShape

TAKEN = tuple(each.name for each in RECIPES)  # names that no recipe of a plant can have
NEEDS = f'storage needs the roles {ARM} (the taker) and {MOBILE} (the giver) and a group "{STATIONS}"'
SECTIONS = ("paths", "stations", "palletizing")  # they may stand at the top of the file, for all such cells


@dataclass(frozen=True, kw_only=True)
class ArmPoses:
    """Poses of the arm; `pickup` is for every exit that `pickups` does not name."""

    home: Pose
    pickup: Pose
    pickups: Pickups
    stations: tuple[Pose, ...]
    palletizing: rack.Targets


def storage_cell(document: Document, place: Place) -> Cell | None:
    """The cell; None, with its problems kept, if something is wrong with it."""
    shape = document.read(CellShape, place)
    kind = arm_model(document, (*place, ARM))
    the_arm = arm(document, (*place, ARM), kind)
    the_mobile = mobile(document, (*place, MOBILE))
    routes = paths(document, _section(document, place, "paths"))
    poses = _poses(document, place, kind, routes)
    keys = common_keys(document, place, shape)
    if the_mobile and routes:
        check_nodes_show(document, (*place, MOBILE), routes, the_mobile)
    if not (shape and keys and the_arm and the_mobile and routes and poses):
        return None
    check_absence(document, place, shape.on_absence, (the_arm, the_mobile))
    return Cell(
        **keys,
        members=((ARM, the_arm), (MOBILE, the_mobile)),
        spaces=(_of_arm(the_arm, routes, poses), _of_mobile(the_mobile, routes)),
        handover=_handover(the_arm, the_mobile, routes, poses),
        arrays=_groups(routes, poses),
        recipes=RECIPES,
    )


def fitting(
    handover: Handover, roles: Mapping[str, Robot], groups: Mapping[str, object]
) -> tuple[Recipe, ...]:
    """The recipes of storage that a cell of devices with this handover can do."""
    meet = {role: robot.name for role, robot in roles.items() if role in (ARM, MOBILE)}
    if meet != {ARM: handover.taker, MOBILE: handover.giver}:
        return ()
    needs: dict[Recipe, str] = {storage: STATIONS, palletizing: PALLETIZING_TARGETS}
    return tuple(recipe for recipe, group in needs.items() if group in groups)


def plan_problems(cell: Cell) -> dict[str, str]:
    """Problems of planning the arm's own cycle: by the name of a pose, the sentence why it is wrong."""
    if PALLETIZING_TARGETS not in cell.groups or cell.handover is None:
        return {}
    _, last = cell.groups[PALLETIZING_TARGETS]
    place = cell.taker.targets[last]
    rule = "palletizing ends and waits there, so it must be outside all zones"
    return {place.name: f"in cell {cell.name}: {zone_plan.lying(place)}; {rule}"} if place.zones else {}


def check_sections(document: Document, cells: Sequence[Place]) -> None:
    """Keep a problem for each section at the top that no cell uses; `cells` are all cells of this form."""
    for key in SECTIONS:
        if (
            document.has((key,))
            and document.has(("cells",))
            and all(document.has((*cell, key)) for cell in cells)
        ):
            why = "every cell has its own" if cells else "no cell has an arm and a mobile robot"
            document.problem((key,), f"{why}, so this section has no effect; delete it")


def _of_arm(the_arm: Arm, routes: tuple[Route, ...], poses: ArmPoses) -> Workspace:
    takes = tuple({pose.name: pose for pose in (poses.pickup, *dict(poses.pickups).values())}.values())
    names = [(HOME, poses.home.name), *_pickup_targets(routes, poses), *_station_targets(poses)]
    pick = dict(names)[poses.palletizing[0]]
    return Workspace(
        robot=the_arm,
        home=poses.home,
        poses=(poses.home, *takes, *poses.stations),
        target_names=tuple(names),
        supplies=tuple(dict.fromkeys((*(pose.name for pose in takes), pick))),
    )


def _of_mobile(the_mobile: Mobile, routes: tuple[Route, ...]) -> Workspace:
    """The workspace of the mobile robot; its targets are the begin of the first path, and the end of each."""
    home = Pose(name=HOME, title=OWN(text=HOME), q=routes[0].nodes[0])
    ends = [Pose(name=path.code, title=OWN(text=path.code), q=path.nodes[-1]) for path in routes]
    return Workspace(robot=the_mobile, home=home, returns=False, poses=(home, *ends), paths=routes)


def _handover(the_arm: Arm, the_mobile: Mobile, routes: tuple[Route, ...], poses: ArmPoses) -> Handover:
    rows = [(exit, path.code) for exit, _ in poses.pickups for path in routes if exit_of(path) == exit]
    return Handover(
        taker=the_arm.name,
        giver=the_mobile.name,
        otherwise="pickup",
        by_path=tuple((code, _pickup_target(exit)) for exit, code in rows),
    )


def _groups(routes: tuple[Route, ...], poses: ArmPoses) -> tuple[tuple[str, tuple[str, ...]], ...]:
    return (
        (STATIONS, tuple(name for name, _ in _station_targets(poses))),
        ("pickups", tuple(name for name, _ in _pickup_targets(routes, poses))),
        ("paths", tuple(path.code for path in routes)),
        (PALLETIZING_TARGETS, poses.palletizing),
    )


def _pickup_targets(routes: tuple[Route, ...], poses: ArmPoses) -> list[tuple[str, str]]:
    """The targets at which the arm takes parts, `pickup` and one for each exit, with the names of poses."""
    own = dict(poses.pickups)
    exits = dict.fromkeys(exit_of(path) for path in routes)
    by_exit = [(_pickup_target(exit), own.get(exit, poses.pickup).name) for exit in exits]
    return [("pickup", poses.pickup.name), *by_exit]


def _pickup_target(exit: str) -> str:
    return f"pickup_{exit.lower()}"


def _station_targets(poses: ArmPoses) -> list[tuple[str, str]]:
    return [(f"station_{number}", pose.name) for number, pose in enumerate(poses.stations)]


def _poses(
    document: Document, place: Place, kind: ArmModel | None, routes: tuple[Route, ...]
) -> ArmPoses | None:
    """The poses of an arm; None, with the problems kept, if one is wrong."""
    if kind is None:
        document.read(PositionShape, (*place, HOME))
        document.read(PoseShape, (*place, "pickup"))
        for exit in document.keys((*place, "pickups")):
            document.read(PoseShape, (*place, "pickups", exit))
        return None
    reader = PoseReader(document=document, cell=str(place[1]), model=kind.name, joints=kind.joints)
    home = reader.home((*place, HOME))
    by_exit = pickups(reader, place, routes)
    pickup = default_pickup(reader, place)
    if pickup is None and by_exit and not document.has((*place, "pickup")):
        pickup = by_exit[0][1]
    stations = rack.stations(reader, _section(document, place, "stations"), home)
    section = _section(document, place, PALLETIZING_TARGETS, needed=False)
    palletizing = rack.palletizing(reader, section, pickup, by_exit or (), stations)
    if not (home and pickup and by_exit is not None and stations and palletizing):
        return None
    return ArmPoses(home=home, pickup=pickup, pickups=by_exit, stations=stations, palletizing=palletizing)


def _section(document: Document, place: Place, key: str, *, needed: bool = True) -> Place:
    """The place of this section for a cell: in the cell, else at the top, where cells share it."""
    if document.has((*place, key)):
        return (*place, key)
    if needed and not document.has((key,)) and document.has(place):
        document.problem(place, f'the key "{key}" is missing, here and at the top of the file')
    return (key,)
