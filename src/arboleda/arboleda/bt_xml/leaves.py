"""What the devices of a cell are to a tree: an action for each verb, a condition on what they report.

A node is called by the role of its device and what that does: `mill_run`, `loader_visit`, `mill_says`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from arboleda.kinds.declared import Device, DeviceVerb, Effect, FactType
from arboleda.kinds.person import PATIENCE_S, Person
from arboleda.model.errors import ConfigError
from arboleda.model.facts import shown
from arboleda.model.plant_model import Cell, Robot

from .nodes import Category, Kind, Port, Way, by_name, children

TYPES: Mapping[type, str] = {bool: "bool", int: "int", float: "double", str: "string"}
ANSWER = "answer"
TELLS = "tells"


def of_cell(cell: Cell) -> dict[str, Kind]:
    """The kinds of nodes of a cell by name; ConfigError where two devices would have the same."""
    found: dict[str, Kind] = {}
    for role, device in cell.roles.items():
        for kind in _of_device(cell, role, device):
            if kind.name in found:
                raise ConfigError(
                    (f"{cell.name}: two of its devices make a node {kind.name}; rename a role",)
                )
            found[kind.name] = kind
    return found


def of_cells(cells: Sequence[Cell]) -> dict[str, Kind]:
    """Those of several cells together; ConfigError where a name is another kind of node in another cell."""
    found: dict[str, Kind] = {}
    for cell in cells:
        for name, kind in of_cell(cell).items():
            if found.setdefault(name, kind) != kind:
                raise ConfigError((f"{name} is not the same in all cells; choose one: --cell {cell.name}",))
    return found


def _of_device(cell: Cell, role: str, device: Robot) -> Iterator[Kind]:
    if device.name in cell.reach:
        yield from _of_robot(cell, role, device)
    elif isinstance(device, Device):
        yield from (_of_verb(role, verb) for verb in device.kind.verbs.values())
        if device.kind.facts:
            yield from _of_facts(role, device.kind.facts)
    elif isinstance(device, Person):
        yield _ask(role)


def _of_robot(cell: Cell, role: str, robot: Robot) -> Iterator[Kind]:
    target = Port(
        name="target", type="string", is_needed=True, words=tuple(cell.spots(robot.name)), about="where to"
    )
    yield _kind(Category.ACTION, f"{role}_go", target)
    yield _kind(Category.DECORATOR, f"{role}_visit", target)
    yield _kind(Category.ACTION, f"{role}_home")
    space = cell.workspaces.get(robot.name)
    if space is not None and space.hand.held_fact is not None:
        yield _kind(Category.ACTION, f"{role}_grip")
        yield _kind(Category.ACTION, f"{role}_let_go")


def _of_verb(role: str, verb: DeviceVerb) -> Kind:
    ports = [_port(name, type, is_needed=True) for name, type in verb.parameters]
    if verb.effect is Effect.QUERY:
        answers = ", ".join(map(shown, verb.answers))
        ports.append(Port(name=ANSWER, type="string", way=Way.OUT, about=f"one of {answers}"))
    return _kind(Category.ACTION, f"{role}_{verb.name}", *ports)


def _of_facts(role: str, facts: Mapping[str, FactType]) -> Iterator[Kind]:
    ports = [_port(name, type, is_needed=False) for name, type in facts.items()]
    within = Port(name="at_most_s", type="double", is_needed=True, about="how long it is waited for, in s")
    told = [replace(each, way=Way.OUT) for each in ports]
    yield _kind(Category.CONDITION, f"{role}_says", *ports)
    yield _kind(Category.ACTION, f"{role}_{TELLS}", *told)
    yield _kind(Category.ACTION, f"{role}_becomes", *ports, within)


def _ask(role: str) -> Kind:
    return _kind(
        Category.ACTION,
        f"{role}_ask",
        Port(name="question", type="string", is_needed=True, about="what is asked"),
        Port(name="answers", type="string", default="done", about="what can be answered, with ; between"),
        Port(
            name="at_most_s",
            type="double",
            default=f"{PATIENCE_S:g}",
            about="how long it is waited for, in s",
        ),
        Port(name=ANSWER, type="string", way=Way.OUT, about="what was answered"),
    )


def _port(name: str, type: FactType, *, is_needed: bool) -> Port:
    words = tuple(map(shown, type.words))
    limits = (type.lower, type.upper) if type.is_limited else None
    return Port(
        name=name,
        type=TYPES[type.type],
        is_needed=is_needed,
        words=words,
        limits=limits,
        about=type.allowed(),
    )


def _kind(category: Category, name: str, *ports: Port) -> Kind:
    fewest, most = children(category)
    return Kind(name=name, category=category, ports=by_name(ports), fewest=fewest, most=most)
