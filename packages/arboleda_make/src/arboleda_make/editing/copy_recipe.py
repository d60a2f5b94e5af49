"""Copy of a recipe in Python as a tree in XML: its function draws it for all of its tasks.

What is drawn is compared. A value that is that of a parameter in all tasks becomes the parameter; where the
nodes differ with a parameter of a few words, a Switch stands around them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count, product
from typing import cast

from py_trees import common, composites
from py_trees.behaviour import Behaviour

from arboleda.drivers import Value, quoted, shown
from arboleda.engine import Context
from arboleda.extension import ArboledaError
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.model.recipe import Limits
from arboleda.recipes import Parameter, Step, WrittenRecipe
from arboleda.recipes.handles import Chain, usable
from arboleda.recipes.place_questions import PlaceQuestion
from arboleda_trees.bt_xml import listed_values, reading, target_groups, writing
from arboleda_trees.bt_xml.findings import Findings
from arboleda_trees.bt_xml.forest import Forest
from arboleda_trees.bt_xml.recipe import tree_recipe
from arboleda_trees.bt_xml.writing import Tag

from . import carry
from .drawing_kit import MOST_WAYS, DrawingKit, DrawnStep, refusal
from .errors import EditError

MOST_TASKS = 1000  # that are compared
SHARES = (0.0, 0.31, 0.5, 0.73, 1.0)  # of the way between the limits of a number


@dataclass(frozen=True)
class Drawn:
    """Node as it is drawn; `name` is what people read of it."""

    name: str
    kind: str
    attributes: Mapping[str, str]
    below: tuple[Drawn, ...]


Task = tuple[Mapping[str, str], Drawn]  # the texts of its values, and what is drawn for them


def tree(model: PlantModel, context: Context, recipe: str, name: str) -> str:
    """The file of a tree `name` that does what a recipe does in a cell of which this is an unused context.

    EditError for a recipe that no tree in XML can express.
    """
    cell = context.cell
    found = next((each for each in cell.recipes if each.name == recipe), None)
    if not isinstance(found, WrittenRecipe):
        raise EditError(f"{quoted(recipe)} is no recipe in Python of {cell.name}")
    if name in [each.name for each in model.recipes]:
        raise EditError(f"there is a recipe {quoted(name)} already; give the copy another name")
    listed = [each.name for each in found.parameters if each.limits(cell) is None]
    root = _merged([*_tasks(context, found)], listed)
    text = writing.document([*_parts(cell, found, name, root)], main_tree_to_execute=carry.tree_name(name))
    _check_values(cell, found, text)
    return text


def _tasks(context: Context, recipe: WrittenRecipe) -> Iterator[Task]:
    """Drawings, one for each task."""
    known = [[*_values(context.cell, each)] for each in recipe.parameters]
    many = 1
    for each in known:
        many *= len(each)
    if many > MOST_TASKS:
        raise EditError(f"{recipe.name} has more than {MOST_TASKS:,} different tasks, too many to compare")
    names = [each.name for each in recipe.parameters]
    for chosen in product(*known):
        values = dict(zip(names, chosen, strict=True))
        try:
            step = usable(recipe.function(DrawingKit(context), **values), f"{recipe.name} returns")
        except EditError:
            raise
        except Exception as error:  # it is user code: whatever it raises is told
            arguments = "".join(f" {key} {shown(value)}" for key, value in values.items())
            why = error if isinstance(error, ArboledaError) else f"{type(error).__name__}: {error}"
            raise EditError(f"{recipe.name}{arguments}: {why}") from error
        yield {key: shown(value) for key, value in values.items()}, _whole(step, names)


def _values(cell: Cell, parameter: Parameter) -> Iterator[Value]:
    """All that a parameter can be; of a number some, with both limits."""
    limits = parameter.limits(cell)
    if limits is None:
        for word in parameter.words(cell):
            yield cast(Value, parameter.value(cell, word))  # of a recipe in Python
        return
    span = limits.upper - limits.lower
    found = [limits.lower + span * share for share in SHARES]
    yield from dict.fromkeys(map(round, found) if limits.whole else found)


def _whole(step: Step, taken: Collection[str]) -> Drawn:
    """All that a recipe returns, as nodes; `taken`: the names of variables that there are already."""
    chosen_by = [node.chosen_by for node in step.iterate() if isinstance(node, DrawnStep)]
    questions = dict.fromkeys(id(each) for each in chosen_by if each is not None)
    free = (name for number in count(1) if (name := f"answer_{number}") not in taken)
    return _drawn(step, {each: f"{{{name}}}" for each, name in zip(questions, free, strict=False)})


def _drawn(step: Behaviour, answers: Mapping[int, str]) -> Drawn:
    """A step as a node; `answers`: the variable of each question that something is chosen by."""
    below = tuple(_drawn(each, answers) for each in step.children)
    if isinstance(step, DrawnStep) and isinstance(step.real, PlaceQuestion):
        return _asked(step, answers.get(id(step)))
    if isinstance(step, DrawnStep):
        answer = {"answer": answers[id(step)]} if id(step) in answers else {}
        by = {} if step.chosen_by is None else {"variable": answers[id(step.chosen_by)]}
        return Drawn(step.name, step.kind, {**by, **step.attributes, **answer}, below)
    if isinstance(step, Chain):
        if len(below) == 1:
            return below[0]
        return Drawn(step.name, "Sequence" if below else "AlwaysSuccess", {}, below)
    if _waits_for_all(step):
        return Drawn(step.name, "Parallel", {"success_count": "-1", "failure_count": "1"}, below)
    raise refusal(step.name, f"it is a {type(step).__name__} made in Python")


def _asked(step: DrawnStep, answer: str | None) -> Drawn:
    """A question to a place as the condition that it is in XML, and the variable for its answer, if any."""
    condition = Drawn(step.name, step.kind, step.attributes, ())
    if answer is None:
        return Drawn("ForceSuccess", "ForceSuccess", {}, (condition,))
    codes = [f"{answer.strip('{}')} := '{shown(each)}'" for each in PlaceQuestion.answers]
    noted = [Drawn("Script", "Script", {"code": code}, ()) for code in codes]
    return Drawn(step.name, "IfThenElse", {}, (condition, *noted))


def _waits_for_all(step: Step) -> bool:
    """True for the `parallel` of recipes."""
    return isinstance(step, composites.Parallel) and isinstance(
        step.policy, common.ParallelPolicy.SuccessOnAll
    )


def _merged(tasks: Sequence[Task], listed: Sequence[str]) -> Drawn:
    """One node for what is drawn for several tasks; EditError where no tree says what they differ in.

    `listed`: the parameters of which all values are among them.
    """
    first = tasks[0][1]
    attributes = _same(tasks) if all(_shape(node) == _shape(first) for _, node in tasks) else None
    if attributes is None:
        return _by_choice(tasks, listed)
    below = [
        _merged([(values, node.below[number]) for values, node in tasks], listed)
        for number in range(len(first.below))
    ]
    return Drawn(first.name, first.kind, attributes, tuple(below))


def _shape(node: Drawn) -> tuple[str, tuple[str, ...], int]:
    return node.kind, tuple(node.attributes), len(node.below)


def _same(tasks: Sequence[Task]) -> dict[str, str] | None:
    """The attributes of a node, a parameter where they are its value; None where one is neither."""
    (values, first), *_ = tasks
    found: dict[str, str] = {}
    for key, text in first.attributes.items():
        if all(node.attributes[key] == text for _, node in tasks):
            found[key] = text
            continue
        parameter = next((p for p in values if all(n.attributes[key] == row[p] for row, n in tasks)), None)
        if parameter is None:
            return None
        found[key] = f"{{{parameter}}}"
    return found


def _by_choice(tasks: Sequence[Task], listed: Sequence[str]) -> Drawn:
    """A Switch on the parameter with which the nodes differ."""
    for parameter in listed:
        words = list(dict.fromkeys(values[parameter] for values, _ in tasks))
        if not 1 < len(words) <= MOST_WAYS:
            continue
        try:
            ways = [_merged([each for each in tasks if each[0][parameter] == word], listed) for word in words]
        except EditError:
            continue
        cases = {f"case_{n}": word for n, word in enumerate(words, 1)}
        others = Drawn("otherwise", "AlwaysFailure", {}, ())
        attributes = {"variable": f"{{{parameter}}}", **cases}
        return Drawn(f"choose by {parameter}", f"Switch{len(ways)}", attributes, (*ways, others))
    raise refusal(
        tasks[0][1].name, f"it differs with {_differences(tasks)} in more than a value that is given as it is"
    )


def _differences(tasks: Sequence[Task]) -> str:
    """The parameters that the tasks differ in."""
    (first, _), *others = tasks
    return " and ".join(name for name in first if any(values[name] != first[name] for values, _ in others))


def _parts(cell: Cell, recipe: WrittenRecipe, name: str, root: Drawn) -> Iterator[Tag]:
    main = carry.tree_name(name)
    about = {"_description": recipe.about} if recipe.about else {}
    yield Tag("BehaviorTree", {"ID": main, **about}, [_tag(root)])
    ports = [Tag("input_port", {"name": each.name}) for each in recipe.parameters]
    fields = [Tag("Metadata", {key: text}) for key, text in _metadata(cell, recipe) if text]
    metadata = [Tag("MetadataFields", {}, fields)] if fields else []
    if ports or metadata:
        yield Tag("TreeNodesModel", {}, [Tag("SubTree", {"ID": main}, [*ports, *metadata])])


def _tag(node: Drawn) -> Tag:
    return Tag(node.kind, node.attributes, [_tag(each) for each in node.below])


def _metadata(cell: Cell, recipe: WrittenRecipe) -> Iterator[tuple[str, str]]:
    """Metadata of the model: the end, and the values of parameters."""
    ends = ("; ".join(f"{what}: {_ending(value)}" for what, value in end) for end in recipe.ends_with)
    yield "ends_with", " | ".join(ends)
    groups: dict[str, str] = {}
    lists: dict[str, str] = {}
    for parameter in recipe.parameters:
        if parameter.limits(cell) is not None:
            continue
        words = [shown(each) for each in _values(cell, parameter)]
        group = next(
            (name for name in (*cell.groups, *words) if target_groups.words(cell, name) == words), None
        )
        if group is not None:
            groups[parameter.name] = group
        elif listed_values.can_be_listed(words):
            lists[parameter.name] = ", ".join(words)
        else:
            raise refusal(parameter.name, "one of its values has a comma, a semicolon or a blank at its end")
    yield target_groups.KEY, "; ".join(f"{name}: {group}" for name, group in groups.items())
    yield listed_values.KEY, "; ".join(f"{name}: {listed}" for name, listed in lists.items())


def _ending(value: Value) -> str:
    return f"'{value}'" if isinstance(value, str) else shown(value)


def _check_values(cell: Cell, recipe: WrittenRecipe, text: str) -> None:
    """EditError where the tasks of the tree would not be those of the recipe."""
    findings = Findings()
    forest = reading.read(f"{recipe.name}.xml", text.encode(), findings)
    if findings.mistakes:
        raise EditError(f"{recipe.name} cannot be drawn: {findings.mistakes[0]}")
    drawn = _parameters(forest, recipe.name, text)
    for before, after in zip(recipe.parameters, drawn, strict=True):
        wanted, found = before.limits(cell), after.limits(cell)
        words = [shown(each) for each in _values(cell, before)]
        if wanted != found or (wanted is None and list(after.words(cell)) != words):
            expected = _range(wanted) if wanted else ", ".join(words)
            taken = _range(found) if found else ", ".join(after.words(cell)) or "nothing"
            raise refusal(before.name, f"it is {expected} in {recipe.name}, and would be {taken} in the tree")


def _parameters(forest: Forest, name: str, text: str) -> tuple[Parameter, ...]:
    return tree_recipe(name, f"{name}.xml", text.encode(), forest, {}).parameters


def _range(limits: Limits) -> str:
    return f"a number from {limits.lower:g} to {limits.upper:g}"
