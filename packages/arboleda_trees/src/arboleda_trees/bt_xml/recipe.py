"""Recipe that is a tree of a file; the ports of the tree are its parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from itertools import chain

from py_trees.behaviour import Behaviour

from arboleda.drivers import quoted
from arboleda.engine import Context, task
from arboleda.model.plant_model import Cell
from arboleda.recipes import Order, Parameter, Recipe, WrittenNode
from arboleda.recipes.holding import held
from arboleda.recipes.of_files import FileRecipe, TreeError, TreeMistakes

from . import ends, leaves, listed_values, parameters, runnable, target_groups
from .comparing import compared
from .findings import Findings
from .forest import Forest
from .nodes import Kind
from .running.build import Builder, control
from .running.devices import Devices
from .running.memory import Scope
from .running.root import Main, Rescue


def tree_recipe(
    name: str,
    file: str,
    content: bytes,
    forest: Forest,
    own: Mapping[str, WrittenNode],
    mistakes: Sequence[str] = (),
) -> FileRecipe:
    """The recipe of the main tree of a forest; each build checks it in the cell.

    `own` are the nodes in Python; more of them may be added until the first build. With `mistakes`, those of
    the file, it cannot be built, only checked.
    """
    main = forest.main
    assert main is not None

    stated = ends.of_tree(forest, main)
    end = tuple(chain.from_iterable(stated))

    def kinds(cell: Cell) -> Mapping[str, Kind]:
        return leaves.of_cell(cell, own.values())

    def check(cell: Cell) -> None:
        unknown = {port.name for port in parameters.of_tree(forest, main)}
        known = [each for each in end if each.what not in unknown]
        _check(name, forest, known, {}, cell, kinds(cell))
        if mistakes:
            raise TreeMistakes(mistakes)

    # The names and values that this function takes in are hashed: with others, no kept task could go on.
    def build(order: Order, context: Context) -> Behaviour:
        _check(name, forest, end, order.values, context.cell, kinds(context.cell))
        return _built(name, forest, main, order, Devices(context, [], own))

    def refuse(order: Order, context: Context) -> Behaviour:
        _check(name, forest, end, order.values, context.cell, kinds(context.cell))
        raise TreeMistakes(mistakes)

    return FileRecipe(
        name=name,
        build=refuse if mistakes else build,
        parameters=_parameters(forest, main, kinds, end),
        about=_about(forest, main),
        ends_with=tuple(tuple((each.what, each.value) for each in way) for way in stated),
        file=file,
        place=forest.trees[main].place,
        content=content,
        groups=target_groups.of_tree(forest, main),
        handed_on=parameters.handed_on(forest, main),
        own=own,
        check=check,
        compared=compared,
    )


def _parameters(
    forest: Forest, main: str, kinds: Callable[[Cell], Mapping[str, Kind]], end: Sequence[ends.End]
) -> tuple[Parameter, ...]:
    ending, groups = {each.what for each in end}, target_groups.of_tree(forest, main)
    listed = listed_values.of_tree(forest, main)
    return tuple(
        parameters.parameter(
            forest,
            main,
            port,
            kinds,
            group=groups.get(port.name),
            listed=listed.get(port.name),
            names_place=port.name in ending,
        )
        for port in parameters.of_tree(forest, main)
    )


def own_nodes(recipes: Iterable[Recipe]) -> dict[str, WrittenNode]:
    """The nodes in Python that the trees among these recipes may use, by name."""
    trees = [each for each in recipes if isinstance(each, FileRecipe)]
    return {name: own for tree in trees for name, own in tree.own.items()}


def _check(
    name: str,
    forest: Forest,
    end: Sequence[ends.End],
    values: Mapping[str, object],
    cell: Cell,
    kinds: Mapping[str, Kind],
) -> None:
    findings = Findings()
    ends.check_in_cell(name, end, values, cell, findings)
    runnable.check_in_cell(forest, cell.name, kinds, findings)


def _about(forest: Forest, main: str) -> str:
    described = forest.trees[main].own.get("_description")
    return described.value.partition("\n")[0] if described is not None else ""


def _built(name: str, forest: Forest, main: str, order: Order, devices: Devices) -> Behaviour:
    context, causes = devices.context, devices.causes
    context.parts.forget_origins()
    scope = Scope(values={key: _variable(value) for key, value in order.values.items()})
    rescues = {"TryCatch": control(partial(Rescue, failures=context.failures, causes=causes))}
    builder = Builder(forest, devices.make, context.time, devices.kinds, controls=rescues)
    tree = builder.tree(main, scope)
    if builder.errors:
        raise TreeMistakes([f"{each.place}: {name} cannot be built: {each}" for each in builder.errors])
    changed = {(id(place), key) for place, key in builder.written}
    for place, key, node in devices.fixed:
        if (id(place), key) in changed:
            why = "which the tree changes while it runs; its way has to be known before"
            raise TreeError(f"{node.kind} is given the variable {quoted(key)}, {why}", node.place)
    work = held(context, Main(name, tree, context.failures, causes))
    return task(name, [work], context, notes_origins=True)


def _variable(value: object) -> float | int | str:
    """A value as a variable holds it: true and false are 1 and 0."""
    if isinstance(value, bool):
        return int(value)
    return value if isinstance(value, int | float | str) else str(value)
