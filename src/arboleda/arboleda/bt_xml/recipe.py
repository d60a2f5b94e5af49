"""A recipe that is a tree of a file: the ports of the tree are its parameters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from py_trees.behaviour import Behaviour

from arboleda.model.facts import Value, shown
from arboleda.model.messages import Failure
from arboleda.model.outside import quoted
from arboleda.model.plant_model import Cell
from arboleda.model.recipe import Parameter, Recipe
from arboleda.model.task import Order
from arboleda.recipes.sharing import held
from arboleda.trees import steps
from arboleda.trees.context import Context

from . import leaves, runnable, values
from .forest import Forest, Node
from .nodes import Kind, Port, Way
from .running.build import Builder
from .running.devices import Devices
from .running.errors import TreeError
from .running.memory import Scope
from .running.root import Main
from .values import Variable

MOST_LEVELS = 50
BOOLS = ("true", "false")


@dataclass(frozen=True, kw_only=True)
class TreeRecipe(Recipe):
    """A recipe of a file; `file` is what people know that by."""

    file: str


def tree_recipe(name: str, file: str, forest: Forest) -> TreeRecipe:
    """The recipe of the main tree of a forest that can be run; in a cell it is checked with each build."""
    main = forest.main
    assert main is not None

    def build(order: Order, context: Context) -> Behaviour:
        runnable.check_in_cell(forest, context.cell.name, leaves.of_cell(context.cell))
        return _built(name, forest, main, order, context)

    model = forest.models.get(main)
    ports = [
        each for each in ((model.ports or {}).values() if model is not None else ()) if each.way is Way.IN
    ]
    parameters = tuple(Parameter(name=port.name, words=partial(_words, forest, main, port)) for port in ports)
    return TreeRecipe(name=name, build=build, parameters=parameters, about=_about(forest, main), file=file)


def _about(forest: Forest, main: str) -> str:
    described = forest.trees[main].own.get("_description")
    return described.value.partition("\n")[0] if described is not None else ""


def _built(name: str, forest: Forest, main: str, order: Order, context: Context) -> Behaviour:
    context.back, context.origins = {}, set()
    causes: list[Failure] = []
    scope = Scope(values={key: shown(_plain(value)) for key, value in order.values.items()})
    devices = Devices(context, causes)
    builder = Builder(forest, devices.make, context)
    tree = builder.tree(main, scope)
    changed = {(id(place), key) for place, key in builder.written}
    for place, key, node in devices.fixed:
        if (id(place), key) in changed:
            why = "which the tree changes while it runs; write a value, or a parameter of the recipe"
            raise TreeError(f"{node.kind} is given the variable {quoted(key)}, {why}", node.place)
    return steps.task(name, [held(context, Main(name, tree, context, causes))], context, notes_origins=True)


def _plain(value: object) -> Value:
    return value if isinstance(value, bool | int | float | str) else str(value)


def _words(forest: Forest, main: str, port: Port, cell: Cell) -> Sequence[str]:
    """What a parameter can be in a cell: what every device takes that is given it."""
    kinds = leaves.of_cell(cell)
    found: list[str] | None = None
    for words in _uses(forest, kinds, main, port.name, 0):
        found = list(words) if found is None else [each for each in found if each in words]
    return found or []


def _uses(
    forest: Forest, kinds: Mapping[str, Kind], tree: str, name: str, level: int
) -> Iterator[Sequence[str]]:
    """What each port takes that is given a variable, in a tree and in those within."""
    if level > MOST_LEVELS or tree not in forest.trees:
        return
    for node in forest.trees[tree].root.iterate():
        for port_name in _given(node, name):
            if node.is_subtree:
                yield from _uses(forest, kinds, node.own["ID"].value, port_name, level + 1)
            elif node.kind in kinds:
                port = (kinds[node.kind].ports or {}).get(port_name)
                if port is not None and (port.words or port.type == "bool"):
                    yield port.words or BOOLS


def _given(node: Node, variable: str) -> Iterator[str]:
    for name, attribute in node.ports.items():
        said = values.read(name, attribute.value)
        if isinstance(said, Variable) and said.name == variable:
            yield name
