"""Targets of a cell of devices: names of places, each with the pose of each robot there."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from arboleda.model.plant_model import Pose, Robot, Workspace

from . import arrays
from .document import Document, Place, misnamed, shown
from .shapes import MAPPING, NAME_RULE, WORDS, is_name
from .target_pose import START, target_pose


def workspaces(
    document: Document, place: Place, roles: Mapping[str, Robot], tools: Mapping[str, Robot]
) -> tuple[Workspace, ...] | None:
    """The workspaces of a cell, with the targets of each robot; None, with the problems kept, if wrong.

    `tools` are the devices that robots carry, by the role of the robot.
    """
    here = (*place, "targets")
    movers = {role: robot for role, robot in roles.items() if robot.goes}
    if not document.has(here):
        for role in movers:
            document.problem(place, f'{role} goes nowhere: the key "targets" is missing')
        return None if movers else ()
    document.read_plain(MAPPING, here)
    spots: dict[str, list[Pose | None]] = {role: [] for role in movers}
    for name in document.keys(here):
        if not is_name(name):
            document.problem((*here, name), f"a target must be {NAME_RULE}", at=(*here, name))
        document.read_plain(MAPPING, (*here, name))
        for role in document.keys((*here, name)):
            if role in movers:
                spots[role].append(target_pose(document, (*here, name, role), movers[role], name))
            else:
                _refuse_role(document, (*here, name, role), movers)
    for array in arrays.arrays(document, place):
        for role, poses in arrays.poses(document, place, array, movers).items():
            spots[role] += poses
        _check_names(document, (*place, "groups", array.group), array, document.keys(here))
    spaces = [
        _workspace(document, here, role, robot, spots[role], tools.get(role))
        for role, robot in movers.items()
    ]
    whole = tuple(space for space in spaces if space is not None)
    return whole if len(whole) == len(spaces) else None


def groups(
    document: Document, place: Place, spaces: Sequence[Workspace]
) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """The groups of targets, each in its order; a problem is kept for each name that is no target."""
    here = (*place, "groups")
    if not document.has(here):
        return ()
    document.read_plain(MAPPING, here)
    targets = {pose.name for space in spaces for pose in space.poses}
    rows = []
    of_corners = {array.group: array.names for array in arrays.arrays(document, place)}
    for name in document.keys(here):
        if not is_name(name) or name in targets:
            rule = f"a group must be {NAME_RULE}" if not is_name(name) else "a target has this name already"
            document.problem((*here, name), rule, at=(*here, name))
        if arrays.is_array(document, (*here, name)):
            rows.append((name, of_corners.get(name, ())))
            continue
        names = document.read_plain(WORDS, (*here, name)) or []
        for index, each in enumerate(names):
            if each not in targets:
                sentence = misnamed(each, sorted(targets), "there are no targets")
                document.problem((*here, name, index), sentence)
        rows.append((name, tuple(names)))
    return tuple(rows)


def _check_names(document: Document, place: Place, array: arrays.Array, targets: Collection[str]) -> None:
    """Keep a problem if an array makes a target that exists already."""
    taken = [name for name in array.names if name in targets]
    if taken:
        document.problem(place, f"it makes a target {shown(taken[0])}, and there is one already", at=place)


def _workspace(
    document: Document,
    place: Place,
    role: str,
    robot: Robot,
    spots: Sequence[Pose | None],
    tool: Robot | None,
) -> Workspace | None:
    poses = tuple(pose for pose in spots if pose is not None)
    home = next((pose for pose in poses if pose.name == START), None)
    if len(poses) < len(spots):
        return None
    if home is None:
        document.problem(place, f'{role} needs a target "{START}", where it waits')
        return None
    return Workspace(robot=robot, tool=tool, home=home, poses=poses)


def _refuse_role(document: Document, place: Place, movers: Mapping[str, Robot]) -> None:
    sentence = misnamed(place[-1], movers, "no device of this cell goes anywhere")
    document.problem(place, sentence, at=place)
