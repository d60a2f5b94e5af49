"""Evaluation of scripts, with variables, numbers and texts, and nothing else."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise

from arboleda.drivers import ArboledaError, quoted, shown
from arboleda.recipes import Phrase
from arboleda_trees.bt_xml import script
from arboleda_trees.bt_xml.script import Assignment, Choice, Comparison, Expression, Infix, Name, Prefix

from .memory import Scope, Value

LONGEST = 10_000  # characters of a text that a script makes
BITS = 63
NOT_BOOL = Phrase("script.not_bool", "{value} is neither true nor false")
UNSET = Phrase("script.unset", "the variable {variable} has no value")
BY_ZERO = Phrase("script.by_zero", "a division by zero")
TOO_LARGE = Phrase("script.too_large", "a number that is too large")
TOO_LONG = Phrase("script.too_long", "a text of more than {most} characters")
OTHER_TYPE = Phrase("script.other_type", "{variable} is {there} and cannot become {value}")
NO_NUMBER = Phrase("script.no_number", "{value} is no number")
NOT_WHOLE = Phrase("script.not_whole", "{number} is no whole number")


class ScriptError(ArboledaError):
    """Error of a script, or of a port, while the tree runs."""


@dataclass(frozen=True)
class Script:
    """Script that was parsed before."""

    text: str
    statements: tuple[Expression, ...]

    @classmethod
    def of(cls, text: str) -> Script:
        return cls(text, script.parse(text))

    def run(self, scope: Scope) -> Value:
        """Run the script; returns the value of the last statement."""
        value: Value = 0
        for statement in self.statements:
            value = evaluate(statement, scope)
        return value

    def holds(self, scope: Scope) -> bool:
        return is_true(self.run(scope))


def is_true(value: Value) -> bool:
    """True if a value counts as true; raises ScriptError for a text that is neither true nor false."""
    if not isinstance(value, str):
        return bool(value)
    if value.lower() in ("true", "1"):
        return True
    if value.lower() in ("false", "0", ""):
        return False
    raise ScriptError(NOT_BOOL(value=quoted(value)))


def evaluate(expression: Expression, scope: Scope) -> Value:
    """The value of an expression; raises ScriptError if it has none."""
    if isinstance(expression, script.Value):
        return expression.value
    if isinstance(expression, Name):
        return _value_of(expression.name, scope)
    if isinstance(expression, Prefix):
        return _prefix(expression.sign, evaluate(expression.operand, scope))
    if isinstance(expression, Comparison):
        return _compared(expression, scope)
    if isinstance(expression, Choice):
        branch = expression.then if is_true(evaluate(expression.condition, scope)) else expression.otherwise
        return evaluate(branch, scope)
    if isinstance(expression, Assignment):
        return _assigned(expression, scope)
    return _infix(expression, scope)


def _value_of(name: str, scope: Scope) -> Value:
    value = scope.get(name)
    if value is None:
        raise ScriptError(UNSET(variable=name))
    return value


def _prefix(sign: str, value: Value) -> Value:
    if sign == "!":
        return float(not is_true(value))
    number = _number(value)
    return -number if sign == "-" else ~_whole(number)


def _infix(expression: Infix, scope: Scope) -> Value:
    left = evaluate(expression.left, scope)
    if expression.sign in ("&&", "||"):
        if is_true(left) is (expression.sign == "||"):
            return float(is_true(left))
        return float(is_true(evaluate(expression.right, scope)))
    return _joined(left, expression.sign, evaluate(expression.right, scope))


def _joined(left: Value, sign: str, right: Value) -> Value:
    if sign == ".." or (sign == "+" and isinstance(left, str) and isinstance(right, str)):
        return _text(left, right)
    one, other = _number(left), _number(right)
    if sign in BITWISE:
        return BITWISE[sign](_whole(one), _whole(other))
    if sign == "/" and other == 0:
        raise ScriptError(BY_ZERO())
    try:
        return CALCULATED[sign](one, other)
    except OverflowError:
        raise ScriptError(TOO_LARGE()) from None


def _text(left: Value, right: Value) -> str:
    text = "".join(each if isinstance(each, str) else spelled(each) for each in (left, right))
    if len(text) > LONGEST:
        raise ScriptError(TOO_LONG(most=LONGEST))
    return text


def spelled(number: float) -> str:
    """A number as text; a whole one without a point."""
    return shown(int(number)) if float(number).is_integer() else shown(number)


def _compared(expression: Comparison, scope: Scope) -> float:
    values = [evaluate(each, scope) for each in expression.operands]
    rows = zip(pairwise(values), expression.signs, strict=True)
    return float(all(_compare(left, sign, right) for (left, right), sign in rows))


def _compare(left: Value, sign: str, right: Value) -> bool:
    if isinstance(left, str) and isinstance(right, str):
        return bool(COMPARED[sign](left, right))
    if isinstance(left, str) or isinstance(right, str):
        left, right = _number(left), _number(right)
    return bool(COMPARED[sign](left, right))


def _assigned(expression: Assignment, scope: Scope) -> Value:
    value = evaluate(expression.value, scope)
    if expression.sign != ":=":
        there = _value_of(expression.name, scope)
        if expression.sign != "=":
            value = _joined(there, expression.sign[0], value)
        elif isinstance(there, str) is not isinstance(value, str):
            raise ScriptError(OTHER_TYPE(variable=expression.name, there=quoted(there), value=quoted(value)))
    scope.set(expression.name, value)
    return value


def _number(value: Value) -> float | int:
    if not isinstance(value, str):
        return value
    try:
        return int(value) if value.lstrip("+-").isdigit() and len(value) < 18 else float(value)
    except ValueError:
        raise ScriptError(NO_NUMBER(value=quoted(value))) from None


def _whole(number: float) -> int:
    if not float(number).is_integer() or abs(number) >= 2**BITS:
        raise ScriptError(NOT_WHOLE(number=spelled(number) if math.isfinite(number) else str(number)))
    return int(number)


Calculation = Callable[[float, float], float]
CALCULATED: Mapping[str, Calculation] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}
BITWISE: Mapping[str, Callable[[int, int], int]] = {"&": operator.and_, "|": operator.or_, "^": operator.xor}
COMPARED: Mapping[str, Callable[[Value, Value], bool]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
}
