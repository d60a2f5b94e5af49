"""Kinds of nodes of a cell: for each device its verbs and its facts, for its places the parts there.

A node of a device is named by its role and the verb: `mill_run`, `loader_visit`, `mill_says`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from arboleda.drivers import Device, DeviceVerb, Effect, FactType, Robot, shown
from arboleda.kinds.person import PATIENCE_S, Person
from arboleda.kinds.ranges import NUMBERS
from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Cell
from arboleda.recipes import WrittenNode
from arboleda.recipes.nodes import Taken

from . import values
from .nodes import MANY, Category, Kind, Port, PortDirection, by_name, children


class NotTheSame(ConfigError):
    """A name means different kinds of nodes in two cells."""


TYPES: Mapping[type, str] = {bool: "bool", int: "int", float: "double", str: "string"}
ANSWER = "answer"
TELLS = "tells"
HAS_PART, HAS_ROOM = "place_has_part", "place_has_room"
GETS_PART, GETS_ROOM = "place_gets_part", "place_gets_room"
WITHIN = Port(name="at_most_s", type="double", is_needed=True, about="how long it is waited for, in s")


def of_cell(cell: Cell, own: Iterable[WrittenNode] = ()) -> dict[str, Kind]:
    """The kinds of nodes of a cell by name, with nodes in Python; ConfigError if two have one name."""
    kinds: dict[str, Kind] = {}
    for role, kind in _of_devices(cell):
        if kind.name in kinds:
            raise ConfigError((_twice(cell, kind.name, role),))
        kinds[kind.name] = kind
    for name, kind in of_places(cell).items():
        if name in kinds:
            raise ConfigError((f"{cell.name}: its devices and its places make a node {name}; rename a role",))
        kinds[name] = kind
    for node in own:
        if node.name in kinds:
            raise ConfigError((f"{cell.name}: it makes a node {node.name} itself; rename that in Python",))
        kinds[node.name] = _of_python(cell, node)
    return kinds


def roles(cell: Cell) -> dict[str, str]:
    """The role of the device that makes each node, by the name of the node."""
    return {kind.name: role for role, kind in _of_devices(cell)}


def _of_devices(cell: Cell) -> Iterator[tuple[str, Kind]]:
    for role, device in cell.roles.items():
        yield from ((role, kind) for kind in _of_device(cell, role, device))


def _twice(cell: Cell, node: str, role: str) -> str:
    """The sentence that two devices make a node of one name, or that one device makes it twice."""
    others = [other for other, kind in _of_devices(cell) if kind.name == node and other != role]
    if not others:
        return f"{cell.name}: {role} makes a node {node} twice; rename a verb of its kind"
    return f"{cell.name}: {others[0]} and {role} both make a node {node}; rename one of these roles"


def of_cells(cells: Sequence[Cell], own: Iterable[WrittenNode] = ()) -> dict[str, Kind]:
    """The kinds of several cells together; NotTheSame if a name means different kinds in two cells."""
    kinds_by_name: dict[str, Kind] = {}
    first: dict[str, str] = {}  # by kind: the first cell that has it
    written = tuple(own)
    with_places = [cell.name for cell in cells if cell.places]
    for cell in cells:
        places = of_places(cell)
        for name, kind in of_cell(cell, written).items():
            if name in places and first.get(name) in with_places:
                kinds_by_name[name] = _at_either(kinds_by_name[name], kind)
            elif kinds_by_name.setdefault(name, kind) != kind:
                one, other = first[name], cell.name
                raise NotTheSame(
                    (f"{name} is not the same in {one} and {other}; choose --cell {one} or --cell {other}",)
                )
            first.setdefault(name, cell.name)
    return kinds_by_name


def of_places(cell: Cell) -> dict[str, Kind]:
    """The kinds of nodes that ask for parts at a place of a cell, or wait for them; none without places."""
    targets = tuple(place.target for place in cell.places)
    place = Port(name="place", type="string", is_needed=True, words=targets, about="at which place")
    kinds = (
        _kind(Category.CONDITION, HAS_PART, place),
        _kind(Category.CONDITION, HAS_ROOM, place),
        _kind(Category.ACTION, GETS_PART, place, WITHIN),
        _kind(Category.ACTION, GETS_ROOM, place, WITHIN),
    )
    return {kind.name: kind for kind in kinds if targets}


def _at_either(one: Kind, other: Kind) -> Kind:
    """A node for the places of two cells."""
    ports = {**(one.ports or {})}
    words = (*ports["place"].words, *(other.ports or {})["place"].words)
    return replace(one, ports={**ports, "place": replace(ports["place"], words=tuple(dict.fromkeys(words)))})


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
        name="target",
        type="string",
        is_needed=True,
        words=tuple(cell.reach[robot.name].targets),
        about="where to",
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
        ports.append(_answer(verb))
    return _kind(Category.ACTION, f"{role}_{verb.name}", *ports)


def _answer(verb: DeviceVerb) -> Port:
    """The port for the variable that gets the answer."""
    about = verb.answer_type.allowed()
    if verb.number is None:
        return Port(name=ANSWER, type="string", direction=PortDirection.OUT, about=f"one of {about}")
    return Port(name=ANSWER, type=TYPES[verb.number.type], direction=PortDirection.OUT, about=about)


def _of_facts(role: str, facts: Mapping[str, FactType]) -> Iterator[Kind]:
    ports = [
        replace(_port(name, type, is_needed=False), can_compare=type.type in NUMBERS)
        for name, type in facts.items()
    ]
    outputs = [replace(each, direction=PortDirection.OUT, can_compare=False) for each in ports]
    for kind in (
        _kind(Category.CONDITION, f"{role}_says", *ports),
        _kind(Category.ACTION, f"{role}_{TELLS}", *outputs),
        _kind(Category.ACTION, f"{role}_becomes", *ports, WITHIN),
    ):
        yield replace(kind, some_of=tuple(facts))


def _of_python(cell: Cell, node: WrittenNode) -> Kind:
    return Kind(
        name=node.name,
        category=_category(node),
        ports=by_name([*(_taken(cell, each) for each in node.takes), *map(_output, node.gives.items())]),
        fewest=node.fewest,
        most=MANY if node.most is None else node.most,
        about=node.about,
    )


def _category(node: WrittenNode) -> Category:
    if not node.is_step:
        return Category.ACTION if node.gives else Category.CONDITION
    if node.most == 0:
        return Category.ACTION
    return Category.DECORATOR if node.most == 1 else Category.CONTROL


def _taken(cell: Cell, taken: Taken) -> Port:
    words = tuple(taken.words(cell))
    limits = None if taken.limits is None else (taken.limits.lower, taken.limits.upper)
    kind = _type_words(taken.type)
    about = ", ".join(words) or kind if limits is None else f"{kind} from {limits[0]:g} to {limits[1]:g}"
    return Port(
        name=taken.name,
        type=TYPES[taken.type],
        is_needed=taken.default is None,
        default=None if taken.default is None else shown(taken.default),
        words=words,
        limits=limits,
        about=about,
    )


def _output(row: tuple[str, type]) -> Port:
    return Port(name=row[0], type=TYPES[row[1]], direction=PortDirection.OUT, about=_type_words(row[1]))


def _type_words(type: type) -> str:
    """A type of Python in words."""
    described = values.TYPES.get(TYPES[type])
    return "text" if described is None else described[0]


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
        Port(name=ANSWER, type="string", direction=PortDirection.OUT, about="what was answered"),
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
