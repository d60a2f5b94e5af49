"""The targets of a cell of devices: places with one name, and where each of its robots stands there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from arboleda.core.model import Pose, Robot, Workspace
from arboleda.core.sentence import OWN
from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile

from .document import Document, Place, choice, nearest, shown
from .poses import PoseReader
from .shapes import MAPPING, NAME_RULE, WORDS, NodeShape, is_name

START = "home"  # the target where each robot waits


def workspaces(
    document: Document, place: Place, roles: Mapping[str, Robot], tools: Mapping[str, Robot]
) -> tuple[Workspace, ...] | None:
    """Where each robot of a cell goes; None, with the problems kept, where something is wrong.

    `tools` are the devices that robots carry, by the role of the robot.
    """
    here = (*place, "targets")
    movers = {role: robot for role, robot in roles.items() if isinstance(robot, (Arm, Mobile))}
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
                spots[role].append(_spot(document, (*here, name, role), movers[role]))
            else:
                _refuse_role(document, (*here, name, role), movers)
    spaces = [
        _workspace(document, here, role, robot, spots[role], tools.get(role))
        for role, robot in movers.items()
    ]
    whole = tuple(space for space in spaces if space is not None)
    return whole if len(whole) == len(spaces) else None


def groups(
    document: Document, place: Place, spaces: Sequence[Workspace]
) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """The groups of targets, each in its order; problems of those that name no target are kept."""
    here = (*place, "groups")
    if not document.has(here):
        return ()
    document.read_plain(MAPPING, here)
    known = {pose.name for space in spaces for pose in space.poses}
    found = []
    for name in document.keys(here):
        if not is_name(name) or name in known:
            rule = f"a group must be {NAME_RULE}" if not is_name(name) else "a target has this name already"
            document.problem((*here, name), rule, at=(*here, name))
        names = document.read_plain(WORDS, (*here, name)) or []
        for index, each in enumerate(names):
            if each not in known:
                must = f"must be {choice(sorted(known))}" if known else "there are no targets"
                document.problem((*here, name, index), f"{must}, is {shown(each)}{nearest(each, known)}")
        found.append((name, tuple(names)))
    return tuple(found)


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


def _spot(document: Document, place: Place, robot: Robot) -> Pose | None:
    """Where one robot stands at one target."""
    name = str(place[-2])
    if isinstance(robot, Mobile):
        shape = document.read(NodeShape, place)
        if shape is not None and shape.node >= robot.grid.size:
            document.problem((*place, "node"), f"must be 0 to {robot.grid.size - 1}, is {shape.node}")
            return None
        return None if shape is None else Pose(name=name, title=OWN(text=name), q=shape.node)
    assert isinstance(robot, Arm)
    reader = PoseReader(document=document, cell=str(place[1]), model=robot.model, joints=robot.joints)
    return reader.home(place) if name == START else reader.pose(place, OWN(text=name))


def _refuse_role(document: Document, place: Place, movers: Mapping[str, Robot]) -> None:
    role = str(place[-1])
    there = f"must be {choice(movers)}" if movers else "no device of this cell goes anywhere"
    document.problem(place, f"{there}, is {shown(role)}{nearest(role, movers)}", at=place)
