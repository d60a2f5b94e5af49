"""Paths of the mobile robots of a cell of devices, and the handover of what they bring."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

from arboleda.model.plant_model import Handover, Robot, Workspace
from arboleda.model.recipe import Recipe

from .document import Document, Place, choice, misnamed, shown
from .own_recipes import SECTION
from .paths import check_nodes_show, paths
from .shapes import MAPPING, HandoverShape
from .storage_form import NEEDS, fitting


def with_paths(
    document: Document, place: Place, roles: Mapping[str, Robot], spaces: Sequence[Workspace]
) -> tuple[Workspace, ...] | None:
    """The workspaces with the paths of their robots; None, with the problems kept, if something is wrong.

    A recovery brings robots home, but a robot with paths stays where it is.
    """
    here = (*place, "paths")
    if not document.has(here):
        return tuple(spaces)
    document.read_plain(MAPPING, here)
    drives: dict[str, Any] = {role: robot for role, robot in roles.items() if robot.floor_grid is not None}
    by_robot = {}
    for role in document.keys(here):
        if role not in drives:
            sentence = misnamed(role, drives, "no robot of this cell drives on a grid")
            document.problem((*here, role), sentence, at=(*here, role))
            return None
        routes = paths(document, (*here, role), drives[role].floor_grid)
        check_nodes_show(document, (*place, "devices", role), routes, drives[role])
        by_robot[drives[role].name] = routes
    if not all(by_robot.values()):
        return None
    return tuple(
        replace(space, paths=by_robot[space.robot.name], returns=False)
        if space.robot.name in by_robot
        else space
        for space in spaces
    )


def handover(
    document: Document, place: Place, roles: Mapping[str, Robot], spaces: Sequence[Workspace]
) -> Handover | None:
    """The handover of a cell; None where there is none, or, with the problems kept, a wrong one."""
    here = (*place, "handover")
    shape = document.read(HandoverShape, here) if document.has(here) else None
    if shape is None:
        return None
    reach = {space.robot.name: space for space in spaces}
    goes = {role: robot for role, robot in roles.items() if robot.name in reach}
    takers = [role for role, robot in goes.items() if robot.has_effector]
    givers = [role for role, robot in goes.items() if robot.floor_grid is not None]
    targets = reach[goes[shape.taker].name].targets if shape.taker in takers else {}
    codes = [path.code for path in reach[goes[shape.giver].name].paths] if shape.giver in givers else []
    by_path = {code.upper(): target for code, target in shape.by_path.items()}
    rows: list[tuple[str, str, Collection[str]]] = [
        ("taker", shape.taker, takers),
        ("giver", shape.giver, givers),
        ("at", shape.at, targets),
    ]
    rows += [(f"by_path.{code}", target, targets) for code, target in shape.by_path.items()]
    wrong = [each for each in rows if each[1] not in each[2]]
    for key, name, allowed in wrong:
        sentence = misnamed(name, allowed, "there is none to choose from")
        document.problem((*here, *key.split(".")), sentence)
    unknown = [code for code in shape.by_path if code.upper() not in codes]
    for code in unknown:
        rule = f"must be a path of {shape.giver}: {choice(codes)}" if codes else f"{shape.giver} has no paths"
        document.problem((*here, "by_path", code), f"{rule}, is {shown(code)}", at=(*here, "by_path", code))
    if wrong or unknown:
        return None
    return Handover(
        taker=goes[shape.taker].name,
        giver=goes[shape.giver].name,
        otherwise=shape.at,
        by_path=tuple(by_path.items()),
    )


def recipes(
    document: Document,
    place: Place,
    handover: Handover | None,
    roles: Mapping[str, Robot],
    groups: Mapping[str, object],
) -> tuple[Recipe, ...]:
    """The recipes of storage that fit a cell with a handover; a problem is kept if it offers none."""
    if handover is None:
        return ()
    offered = fitting(handover, roles, groups)
    if not offered and not document.has(SECTION):
        document.problem(place, f'offers no recipe: {NEEDS}; or "uses" names a file with recipes', at=place)
    return offered
