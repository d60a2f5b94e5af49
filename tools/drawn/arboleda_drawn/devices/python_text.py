"""Drawn recipes as a file of Python, roughly as a person would write it."""

from __future__ import annotations

from collections.abc import Sequence

from .steps import (
    Ask,
    Choice,
    Choose,
    Fail,
    Fallback,
    Follow,
    Gets,
    Invert,
    Limits,
    OfPaths,
    Parallel,
    Param,
    Parameter,
    Range,
    Recipe,
    Recover,
    Repeat,
    Retry,
    Run,
    Step,
    Tell,
    Timeout,
    Tour,
    Using,
    Value,
    Visit,
    Wait,
    Work,
    call_of,
    walk,
)

WIDTH = 100
HEAD = """\"\"\"Recipes that were drawn from a seed.\"\"\"

from arboleda.recipes import Choice, Number, Path, Pick, Place, Target, parallel, recipe, work
"""


def python_of(recipes: Sequence[Recipe]) -> str:
    """The file with these recipes."""
    return HEAD + "".join(f"\n\n{_recipe(each)}\n" for each in recipes)


def _recipe(recipe: Recipe) -> str:
    given = ", ".join(["cell", *map(_parameter, recipe.parameters)])
    calls = [each for each in walk(recipe.step) if isinstance(each, Ask) or getattr(each, "answer", None)]
    calls = [each for each in calls if not isinstance(each, Choose)]
    roles = dict.fromkeys(str(each.role) for each in walk(recipe.step) if hasattr(each, "role"))
    lines = [f"    {role} = cell.device({role!r})" for role in roles]
    lines += [f"    {each.answer} = {_call(each)}" for each in calls if isinstance(each, Ask | Tell)]
    said = [dict(each) for each in recipe.all_ends]
    ends = f", ends_with={said if len(said) > 1 else said[0]!r}" if said else ""
    head = f"@recipe({recipe.name!r}{ends})\ndef {recipe.name}({given}):\n"
    return head + "\n".join([*lines, f"    return {_text(_whole(recipe.step), 1)}"])


def _whole(step: Step) -> Step:
    return step if isinstance(step, Work) and step.steps else Work(steps=(step,))


def _parameter(parameter: Parameter) -> str:
    if isinstance(parameter, Choice):
        return f"{parameter.name}=Choice({', '.join(map(repr, parameter.words))})"
    if isinstance(parameter, Limits):
        return f"{parameter.name}=Number({parameter.lower!r}, {parameter.upper!r})"
    if isinstance(parameter, OfPaths):
        return f"{parameter.name}=Path()"
    return f"{parameter.name}=Target({parameter.group!r})"


def _text(step: Step, depth: int) -> str:
    """The expression of a step, over several lines where it is long."""
    if isinstance(step, Ask | Tell) and step.answer:
        return step.answer
    parts = _parts(step)
    if parts is None:
        return _call(step)
    head, inner, tail = parts
    return _joined(
        head, [each if isinstance(each, str) else _text(each, depth + 1) for each in inner], tail, depth
    )


def _joined(head: str, inner: Sequence[str], tail: str, depth: int) -> str:
    line = f"{head}{', '.join(inner)}{tail}"
    if "\n" not in line and len(line) + 4 * depth < WIDTH:
        return line
    space = "\n" + "    " * (depth + 1)
    return head + space + space.join(f"{each}," for each in inner) + "\n" + "    " * depth + tail


def _parts(step: Step) -> tuple[str, list[Step | str], str] | None:
    """The beginning, what stands in it, and the end; None for a step without steps."""
    if isinstance(step, Work):
        return ("work(", list(step.steps), ")") if step.steps else None
    if isinstance(step, Parallel):
        return "parallel(", list(step.branches), ")"
    if isinstance(step, Fallback):
        return "cell.fallback(", list(step.steps), ")"
    if isinstance(step, Recover):
        return "cell.recover(", [step.work, step.rescue], ")"
    if isinstance(step, Retry):
        causes = [f"causes={list(step.causes)!r}"] if step.causes else []
        return "cell.retry(", [step.step, f"times={step.times}", f"pause_s={step.pause_s}", *causes], ")"
    if isinstance(step, Repeat):
        return "cell.repeat(", [step.step, str(step.times)], ")"
    if isinstance(step, Timeout):
        return "cell.timeout(", [step.step, str(step.seconds)], ")"
    if isinstance(step, Invert):
        return "cell.invert(", [step.step], ")"
    if isinstance(step, Using):
        return f"cell.using({list(step.roles)!r}, ", [step.step], ")"
    if isinstance(step, Visit):
        body = [] if step.body == Work() else [step.body]
        return f"{step.role}.visit(", [_value(step.target), *body], ")"
    if isinstance(step, Choose):
        return f"cell.choose({step.answer}, {{", [_way(value, way) for value, way in step.ways], "})"
    return None


def _way(value: Value | Range, way: Step) -> str:
    return f"{_value(value)}: {'[]' if way == Work() else _text(way, 3)}"


def _call(step: Step) -> str:
    call = call_of(step)
    if call is not None:
        words = [_value(value) for _, value in call.given[: call.unnamed]]
        named = [_given(call.given[call.unnamed :])] if call.given[call.unnamed :] else []
        return f"{call.role}.{call.verb}({', '.join([*words, *named])})"
    if isinstance(step, Gets):
        return f"cell.place({_value(step.place)}).gets_{step.what}(at_most_s={step.at_most_s})"
    if isinstance(step, Tour):
        return f"{step.role}.tour(Pick({_value(step.source)}), Place({step.goal!r}), 'home')"
    if isinstance(step, Follow):
        return f"{step.role}.follow({_value(step.path)})"
    if isinstance(step, Fail):
        return f"cell.fail({step.sentence!r})"
    if isinstance(step, Run):
        return f"cell.run({', '.join([step.recipe, *([_given(step.values)] if step.values else [])])})"
    return f"cell.wait({step.seconds if isinstance(step, Wait) else 0})"


def _given(values: Sequence[tuple[str, Value | Param | Range | tuple[str, ...]]]) -> str:
    return ", ".join(f"{name}={_value(value)}" for name, value in values)


def _value(value: Value | Param | Range | tuple[str, ...]) -> str:
    if isinstance(value, Param):
        return value.name
    if isinstance(value, Range):
        return repr(str(value))
    return repr(list(value) if isinstance(value, tuple) else value)
