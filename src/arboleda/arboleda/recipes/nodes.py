"""Nodes of one's own for trees as XML: functions with inputs and outputs.

@node("BehindClosedDoor")
def behind_closed_door(cell, child):
    mill = cell.device("mill")
    return work(mill.close(), child, mill.open())

@function("GripForce", gives={"force": float})
def grip_force(grams: float, margin: Number[1, 5] = 2):
    return {"force": grams * 0.00981 * margin}

A `node` returns a step, as a recipe does. A node with a `child` is a decorator, with `*children` a control. A
`function` is called while the tree runs.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from inspect import Parameter as Declared
from typing import Any

from arboleda.engine import Context
from arboleda.model.facts import Value
from arboleda.model.outside import quoted
from arboleda.model.plant_model import Cell
from arboleda.model.recipe import Limits

from .authoring import Kit, Making, check_choices, notes_of
from .errors import RecipeError
from .handles import Step, usable
from .parameters import Choice, Number, Target, parameter

RETURNS = "a node returns a step, e.g. work(...)"
CHILD = "child"
PLAIN = (int, float, bool, str)
Function = Callable[..., Any]


@dataclass(frozen=True, kw_only=True)
class Taken:
    """A value that a node takes. `words` are all its values in a cell; empty where they are not listed."""

    name: str
    type: type[Value]
    words: Callable[[Cell], Sequence[str]] = lambda cell: ()
    limits: Limits | None = None
    default: Value | None = None


@dataclass(frozen=True, kw_only=True)
class WrittenNode:
    """A node that is a function. `most` None: any number of children. `is_step`: it returns a step."""

    name: str
    function: Function
    takes: tuple[Taken, ...] = ()
    gives: Mapping[str, type[Value]] = field(default_factory=dict)
    fewest: int = 0
    most: int | None = 0
    is_step: bool
    about: str = ""

    def build(self, context: Context, children: Sequence[Step], values: Mapping[str, Value]) -> Step:
        """The step of the node, around its children; RecipeError where the function returns none."""
        making = Making()
        step = usable(
            self.function(Kit(context, making), *children, **values), f"{self.name} returns", RETURNS
        )
        check_choices(step, making)
        there = {id(each) for each in step.iterate()}
        if any(id(each) not in there for each in children):
            raise RecipeError(f"{self.name} returns a step in which one of its children is not")
        return step

    def calculate(self, values: Mapping[str, Value]) -> Mapping[str, Value] | None:
        """The result of the function with these values; None where the node fails.

        RecipeError for any other result, and for every exception of the function.
        """
        try:
            result = self.function(**values)
        except Exception as error:
            raise RecipeError(f"{self.name} raised {type(error).__name__}: {error}") from error
        if not self.gives:
            if not isinstance(result, bool):
                raise RecipeError(f"{self.name} returned {quoted(result)}; it is to return True or False")
            return {} if result else None
        if result is None:
            return None
        if not isinstance(result, Mapping) or set(result) != set(self.gives):
            names = ", ".join(self.gives)
            raise RecipeError(f"{self.name} returned {quoted(result)}; it is to return a dict of {names}")
        return {name: self._given(name, value) for name, value in result.items()}

    def _given(self, name: str, value: object) -> Value:
        wanted = self.gives[name]
        if wanted is float and type(value) is int:
            value = float(value)
        if not isinstance(value, wanted) or (isinstance(value, float) and not math.isfinite(value)):
            raise RecipeError(
                f"{name} of {self.name} became {quoted(value)}; it is to be a {wanted.__name__}"
            )
        return value


def node(name: str, *, children: tuple[int, int] | None = None) -> Callable[[Function], WrittenNode]:
    """Makes a node for trees as XML of a function of a Kit, of the steps below the node, and of values.

    The function returns a step, as a recipe does. `children` are the least and the greatest number of
    `*children`.
    """

    def made(function: Function) -> WrittenNode:
        declared = list(inspect.signature(function).parameters.values())[1:]
        first = declared[0] if declared else None
        many = first is not None and first.kind is Declared.VAR_POSITIONAL
        one = first is not None and first.name == CHILD
        if children is not None and not (many and 0 < children[0] <= children[1]):
            raise RecipeError(f"{name}: children=(least, most) is for a function of (cell, *children)")
        fewest, most = children or ((1, None) if many else (1, 1) if one else (0, 0))
        values = declared[1:] if many or one else declared
        return WrittenNode(
            name=name,
            function=function,
            takes=_taken(name, function, values),
            fewest=fewest,
            most=most,
            is_step=True,
            about=_about(function),
        )

    return made


def function(
    name: str, *, gives: Mapping[str, type[Value]] | None = None
) -> Callable[[Function], WrittenNode]:
    """Makes a node for trees as XML of a function of values, which is called while the tree runs.

    The function returns a dict of the values that it `gives`, or None where it fails. A function that gives
    none is a condition, and returns True or False.
    """

    def made(function: Function) -> WrittenNode:
        given = dict(gives or {})
        for each, type in given.items():
            if type not in PLAIN:
                raise RecipeError(f"{name} gives {each}, a {quoted(type)}; it gives int, float, bool or str")
        takes = _taken(name, function, list(inspect.signature(function).parameters.values()))
        if both := set(given).intersection(each.name for each in takes):
            raise RecipeError(f"{name} takes and gives {', '.join(sorted(both))}; call one of them otherwise")
        return WrittenNode(
            name=name, function=function, takes=takes, gives=given, is_step=False, about=_about(function)
        )

    return made


def _about(function: Function) -> str:
    return (inspect.getdoc(function) or "").partition("\n")[0]


def _taken(name: str, function: Function, declared: Sequence[Declared]) -> tuple[Taken, ...]:
    notes = notes_of(name, function)
    return tuple(_one(name, each, notes.get(each.name, each.default)) for each in declared)


def _one(node: str, declared: Declared, note: object) -> Taken:
    name, default = declared.name, declared.default
    plain = default if isinstance(default, PLAIN) else None
    if note in PLAIN:
        return Taken(name=name, type=note, default=plain)
    if isinstance(note, Choice):
        types = {type(each) for each in note.values}
        if len(types) != 1:
            raise RecipeError(f"{node}: the values of {name} are to be of one type")
        return Taken(name=name, type=types.pop(), words=_words(name, note), default=plain)
    if isinstance(note, Number):
        return Taken(name=name, type=int if note.limits.whole else float, limits=note.limits, default=plain)
    if isinstance(note, Target) or note is Target:
        return Taken(name=name, type=str, words=_words(name, note), default=plain)
    forms = f"{name}: float, {name}: Choice[1, 2] or {name}=Target(...)"
    raise RecipeError(f"{node}: {name} needs what it can be, e.g. {forms}")


def _words(name: str, note: object) -> Callable[[Cell], Sequence[str]]:
    """The words of a recipe's parameter with this annotation."""
    declared = parameter(name, note)
    assert declared is not None
    return declared.words
