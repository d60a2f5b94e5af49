"""New tree in which a robot takes a part from one place to another, as a person would draw it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from arboleda.drivers import Device, DeviceVerb, FactType, Robot, Slot, Value, among, quoted, shown
from arboleda.extension import ArboledaError
from arboleda.model.plant_model import Cell
from arboleda_trees.bt_xml.writing import attribute_value

NO_HAND = "{robot} of {cell} has nothing to take a part with; {known}"
FORM = """<?xml version="1.0" encoding="UTF-8"?>
<root BTCPP_format="4" main_tree_to_execute="{name}">
  <BehaviorTree ID="{name}" _description={about}>
    <Sequence>
      <{robot}_visit target={start}>
        {grip}
      </{robot}_visit>
      <{robot}_visit target={end}>
        {let_go}
      </{robot}_visit>
      <{robot}_home/>
    </Sequence>
  </BehaviorTree>{model}
</root>
"""
MODEL = """
  <TreeNodesModel>
    <SubTree ID="{name}">
      <MetadataFields>
        <Metadata ends_with={ends}/>
      </MetadataFields>
    </SubTree>
  </TreeNodesModel>"""


def carriers(cell: Cell) -> Iterator[str]:
    """The roles of the robots that can take a part somewhere."""
    return (role for role in cell.roles if _hand(cell, role) is not None)


def tree(cell: Cell, name: str, *, robot: str, start: str, end: str) -> str:
    """The file of the tree; ArboledaError where the robot has no hand, or does not go there."""
    hand = _hand(cell, robot)
    if hand is None:
        raise ArboledaError(
            NO_HAND.format(robot=quoted(robot), cell=cell.name, known=among(robot, [*carriers(cell)]))
        )
    there = cell.reach[cell.roles[robot].name].targets
    for target in (start, end):
        if target not in there:
            raise ArboledaError(f"{quoted(target)} is no target of {robot}; {among(target, [*there])}")
    grip, let_go = hand
    about = _in_quotes(f"Take a part from {start} to {end}.")
    places = {"start": _in_quotes(start), "end": _in_quotes(end)}
    ends = "; ".join(_ends(cell, start, end))
    model = MODEL.format(name=tree_name(name), ends=_in_quotes(ends)) if ends else ""
    form = {"name": tree_name(name), "about": about, "robot": robot, "model": model}
    return FORM.format(**form, grip=grip, let_go=let_go, **places)


def _ends(cell: Cell, start: str, end: str) -> Iterator[str]:
    """The parts that it leaves in or under devices: one where it puts it, none where it took it."""
    for place in cell.places:
        is_alone = place.device is not None and not place.by_people and place.holds == 1
        if place.target in (start, end) and is_alone:  # of several nobody knows how many there were
            yield f"{place.target}: {int(place.target == end)}"


def _hand(cell: Cell, role: str) -> tuple[str, str] | None:
    """The nodes by which a robot grips and lets go; None if it has nothing to do so."""
    robot = cell.roles.get(role)
    space = None if robot is None else cell.workspaces.get(robot.name)
    if space is None or space.hand.held_fact is None:
        return None
    if space.tool is None:
        return f"<{role}_grip/>", f"<{role}_let_go/>"
    return _tool(next(name for name, each in cell.roles.items() if each is space.tool), space.tool)


def _tool(role: str, tool: Robot) -> tuple[str, str] | None:
    """The nodes by which a tool holds a part and lets it go; None where no verb of it does."""
    verbs = tool.kind.verbs.values() if isinstance(tool, Device) else ()
    grip = next((each for each in verbs if each.holds and each.held[1] is not False), None)
    let_go = next((each for each in verbs if each.lets_go()), None)
    if grip is None or let_go is None:
        return None
    return _node(role, grip.name, _gripping(grip)), _node(role, let_go.name, let_go.letting_go())


def _gripping(verb: DeviceVerb) -> Mapping[str, Value]:
    """Values with which a verb holds a part: the middle between limits, to be adjusted by a person."""
    held = verb.held[1]
    slot = held.name if isinstance(held, Slot) else None
    return {name: True if name == slot else _middle(type) for name, type in verb.parameters}


def _middle(type: FactType) -> Value:
    return type.type((type.lower + type.upper) / 2) if type.is_limited else type.first


def _node(role: str, verb: str, values: Mapping[str, Value]) -> str:
    attributes = "".join(f" {name}={_in_quotes(shown(value))}" for name, value in values.items())
    return f"<{role}_{verb}{attributes}/>"


def tree_name(recipe: str) -> str:
    """The name of the tree of a recipe: "to_press" is ToPress."""
    return "".join(word.capitalize() for word in recipe.replace("-", "_").split("_"))


def _in_quotes(text: str) -> str:
    return f'"{attribute_value(text)}"'
