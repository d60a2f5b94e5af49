"""Groups of roles of a cell that nothing joins: no need, no zone, no tool."""

from __future__ import annotations

from .layout import Layout


def groups_apart(layout: Layout) -> tuple[frozenset[str], ...]:
    """The groups of roles that can work at the same time."""
    groups = [{each.role} for each in layout.members]
    groups += [{name} for name in layout.people]
    for pair in _pairs(layout):
        joined = [each for each in groups if each & pair]
        groups = [each for each in groups if not each & pair] + [set().union(*joined)]
    return tuple(frozenset(each) for each in groups)


def _pairs(layout: Layout) -> list[set[str]]:
    found = [{role, other} for (role, _), needs in layout.needs.items() for other, _, _ in needs]
    found += [{each.role, each.tool_of} for each in layout.devices if each.tool_of]
    for robot in layout.robots:
        found += [{robot.role, door[0]} for door in robot.doors.values() if door is not None]
    in_zones = {each.role for each in layout.robots if each.doors}
    if len(in_zones) > 1:
        found.append(in_zones)
    if layout.parts is not None and layout.parts.machine:
        found.append({layout.parts.robot, layout.parts.machine})
    return found
