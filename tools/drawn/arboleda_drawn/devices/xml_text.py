"""Drawn recipes as trees of BehaviorTree.CPP, a file for each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from .steps import (
    Choose,
    Ends,
    Fail,
    Fallback,
    Gets,
    Invert,
    Parallel,
    Param,
    Range,
    Recipe,
    Recover,
    Repeat,
    Retry,
    Run,
    Step,
    Timeout,
    Value,
    Visit,
    Wait,
    Work,
    call_of,
    walk,
)


class Writer:
    """Writer of steps as nodes, each in the plainest way; `trees` are those that it made on the way."""

    def __init__(self) -> None:
        self.trees: list[Element] = []

    def add(self, parent: Element, step: Step) -> None:
        """Write a step below a node."""
        if isinstance(step, Choose) and any(isinstance(value, Range) for value, _ in step.ways):
            self._by_number(parent, step)
            return
        name, given, inner = _node(step)
        made = SubElement(parent, name, given)
        for each in inner:
            self.add(made, each)
        if isinstance(step, Choose) and len(step.ways) > 1:
            SubElement(made, "AlwaysFailure")

    def _by_number(self, parent: Element, step: Choose) -> None:
        """A node for each range but the last one, each within the other."""
        *ways, (_, last) = step.ways
        for value, way in ways:
            parent = SubElement(parent, "IfThenElse")
            SubElement(parent, "ScriptCondition", {"code": fits(step, value)})
            self.add(parent, way)
        self.add(parent, last)


def xml_of(recipe: Recipe, others: Mapping[str, Recipe], writer: Writer) -> str:
    """The file of a recipe, with those of `others` that it runs."""
    main = _id(recipe.name)
    root = Element("root", {"BTCPP_format": "4", "main_tree_to_execute": main})
    for each in _together(recipe, others):
        tree = SubElement(root, "BehaviorTree", {"ID": _id(each.name)})
        writer.add(tree, each.step)
    root.extend(writer.trees)
    model = SubElement(SubElement(root, "TreeNodesModel"), "SubTree", {"ID": main})
    for parameter in recipe.parameters:
        SubElement(model, "input_port", {"name": parameter.name})
    if recipe.all_ends:
        ends = " | ".join(map(_whole_end, recipe.all_ends))
        SubElement(SubElement(model, "MetadataFields"), "Metadata", {"ends_with": ends})
    indent(root)
    return tostring(root, encoding="unicode") + "\n"


def _whole_end(ends: Ends) -> str:
    return "; ".join(f"{what}: {_end(value)}" for what, value in ends)


def _end(value: Value) -> str:
    """A value in metadata: a text in quotes, so that it is read as no number."""
    return f"'{value}'" if isinstance(value, str) else text_of(value)


def _together(recipe: Recipe, others: Mapping[str, Recipe]) -> list[Recipe]:
    """The recipe and those that it runs, each once."""
    found = {recipe.name: recipe}
    waiting = [recipe]
    while waiting:
        for step in walk(waiting.pop().step):
            if isinstance(step, Run) and step.recipe not in found:
                found[step.recipe] = others[step.recipe]
                waiting.append(others[step.recipe])
    return list(found.values())


def _id(name: str) -> str:
    return name.capitalize()


def _node(step: Step) -> tuple[str, dict[str, str], Sequence[Step]]:
    """The name of a node, its attributes and the steps below it."""
    call = call_of(step)
    if call is not None:
        answer = getattr(step, "answer", "")
        given = {name: text_of(value) for name, value in call.given}
        below = (step.body,) if isinstance(step, Visit) else ()
        return f"{call.role}_{call.verb}", given | ({"answer": f"{{{answer}}}"} if answer else {}), below
    if isinstance(step, Gets):
        place = {"place": text_of(step.place), "at_most_s": text_of(step.at_most_s)}
        return f"place_gets_{step.what}", place, ()
    if isinstance(step, Choose) and len(step.ways) == 1:
        return "Sequence", {}, [step.ways[0][1]]
    if isinstance(step, Choose):
        cases = {f"case_{n}": text_of(value) for n, (value, _) in enumerate(step.ways, 1)}
        ways = [way for _, way in step.ways]
        return f"Switch{len(ways)}", {"variable": f"{{{step.answer}}}", **cases}, ways
    if isinstance(step, Work):
        return ("Sequence", {}, step.steps) if step.steps else ("AlwaysSuccess", {}, ())
    if isinstance(step, Parallel):
        return "Parallel", {"success_count": "-1", "failure_count": "1"}, step.branches
    if isinstance(step, Fallback):
        return "Fallback", {}, step.steps
    if isinstance(step, Recover):
        return "TryCatch", {}, (step.work, step.rescue)
    if isinstance(step, Retry):
        return "RetryUntilSuccessful", {"num_attempts": str(step.times + 1)}, (step.step,)
    if isinstance(step, Repeat):
        return "Repeat", {"num_cycles": str(step.times)}, (step.step,)
    if isinstance(step, Timeout):
        return "Timeout", {"msec": msec_of(step.seconds)}, (step.step,)
    if isinstance(step, Invert):
        return "Inverter", {}, (step.step,)
    if isinstance(step, Run):
        given = {name: text_of(value) for name, value in step.values}
        return "SubTree", {"ID": _id(step.recipe), **given}, ()
    if isinstance(step, Fail):
        return "AlwaysFailure", {"name": step.sentence}, ()
    return (
        ("Sleep", {"msec": msec_of(step.seconds)}, ())
        if isinstance(step, Wait)
        else ("AlwaysFailure", {}, ())
    )


def fits(step: Choose, value: Value | Range) -> str:
    """The script that says whether the answer is of this way."""
    if not isinstance(value, Range):
        return f"{step.answer} == {literal(value)}"
    if not value.comparisons:
        return " && ".join(f"!({fits(step, each)})" for each, _ in step.ways if each != value)
    return " && ".join(f"{step.answer} {sign} {limit}" for sign, limit in value.comparisons)


def literal(value: Value) -> str:
    """A value in a script."""
    return f"'{value}'" if isinstance(value, str) else text_of(value)


def text_of(value: Value | Param | Range | tuple[str, ...]) -> str:
    """A value as an attribute of a node."""
    if isinstance(value, tuple):
        return ";".join(value)
    if isinstance(value, Param):
        return f"{{{value.name}}}"
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value)


def msec_of(seconds: float) -> str:
    """A time as an attribute of a node."""
    return str(max(1, round(seconds * 1000)))
