"""Source of recipes in Python: where steps stand in it, and how a text is changed there."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from arboleda.plant_check.mend import Cut

IN_TURN = ("work", "using", "visit")  # calls whose arguments are done one after the other
ALONE = ("parallel", "retry", "fallback", "recover", "timeout", "repeat")  # each is one step
WITH_TARGET = ("visit", "using")  # of these the first argument is no step
Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True, kw_only=True)
class Element:
    """Element: an expression that stands for a step; `siblings` are those that are done in turn with it, none
    where there is room for it alone.
    """

    node: ast.expr
    function: Function
    siblings: tuple[ast.expr, ...] = ()
    parent: ast.AST

    @property
    def number(self) -> int:
        return self.siblings.index(self.node)


class PythonSource:
    """PythonSource: the text of a file, parsed; SyntaxError where it is no Python."""

    def __init__(self, file: str, text: str) -> None:
        self.file, self.text = file, text
        self.tree = ast.parse(text)
        self._starts = [0]
        for line in text.splitlines(keepends=True):
            self._starts.append(self._starts[-1] + len(line))
        self._lines = text.splitlines(keepends=True)

    def start(self, node: ast.expr) -> int:
        return self._offset(node.lineno, node.col_offset)

    def end(self, node: ast.expr) -> int:
        return self._offset(node.end_lineno or node.lineno, node.end_col_offset or 0)

    def source(self, node: ast.expr) -> str:
        return self.text[self.start(node) : self.end(node)]

    def _offset(self, line: int, column: int) -> int:
        return self._starts[line - 1] + len(self._lines[line - 1].encode()[:column].decode())

    @cached_property
    def functions(self) -> tuple[Function, ...]:
        return tuple(each for each in self.tree.body if isinstance(each, ast.FunctionDef))

    @cached_property
    def elements(self) -> tuple[Element, ...]:
        """The expressions that stand for steps, in their order."""
        return tuple(each for function in self.functions for each in self._of(function))

    def _of(self, function: Function) -> Iterator[Element]:
        for statement in function.body:
            for parent in ast.walk(statement):
                yield from _children(function, parent)

    def cut(self, start: int, end: int, new: str) -> Cut:
        return Cut(file=self.file, start=start, end=end, new=new)

    def before(self, element: Element, step: str) -> tuple[Cut, ...]:
        """The cuts that put a step before an element."""
        start, end = self.start(element.node), self.end(element.node)
        if element.siblings:
            return (self.cut(start, start, f"{step}, "),)
        return self.cut(start, start, f"work({step}, "), self.cut(end, end, ")")

    def after(self, element: Element, step: str) -> tuple[Cut, ...]:
        """The cuts that put a step behind an element."""
        start, end = self.start(element.node), self.end(element.node)
        if element.siblings:
            return (self.cut(end, end, f", {step}"),)
        return self.cut(start, start, "work("), self.cut(end, end, f", {step})")

    def inside(self, call: ast.Call, step: str, *, first: bool = False) -> tuple[Cut, ...]:
        """The cuts that put a step at the end, or the beginning, of what is done at a target."""
        at = self.end(call.args[0 if first else -1])
        return (self.cut(at, at, f", {step}"),)

    def without(self, element: Element) -> tuple[Cut, ...]:
        """The cuts that take an element away, which has siblings or stands behind a target."""
        call = element.parent
        around = list(call.args) if isinstance(call, ast.Call) else list(element.siblings)
        number = around.index(element.node)
        if number > 0:
            return (self.cut(self.end(around[number - 1]), self.end(element.node), ""),)
        if len(around) > 1:
            return (self.cut(self.start(element.node), self.start(around[1]), ""),)
        return (self.cut(self.start(element.node), self.end(element.node), ""),)

    def handle_of(self, role: str, function: Function) -> str | None:
        """The name of the device in a role in a function, or how it gets it; None where it has no cell."""
        if not function.args.args:
            return None
        for statement in function.body:
            found = _assigned(role, statement)
            if found is not None:
                return found
        return f'{function.args.args[0].arg}.device("{role}")'

    def handles(self, function: Function) -> Iterator[str]:
        """The names that a function has for devices."""
        for statement in function.body:
            if isinstance(statement, ast.Assign) and called(statement.value) in ("device", "devices"):
                target = statement.targets[0]
                names = target.elts if isinstance(target, ast.Tuple) else [target]
                yield from (each.id for each in names if isinstance(each, ast.Name))


def called(node: ast.AST) -> str:
    """The name of what is called; empty for what is no call."""
    if not isinstance(node, ast.Call):
        return ""
    function = node.func
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def _children(function: Function, parent: ast.AST) -> Iterator[Element]:
    name = called(parent)
    if isinstance(parent, ast.Call) and name in IN_TURN:
        steps = tuple(parent.args[1:] if name in WITH_TARGET else parent.args)
        for each in steps:
            if not isinstance(each, ast.Constant | ast.Starred):
                yield Element(node=each, function=function, siblings=steps, parent=parent)
    elif isinstance(parent, ast.List):
        for each in parent.elts:
            if isinstance(each, ast.Call | ast.Name):
                yield Element(node=each, function=function, siblings=tuple(parent.elts), parent=parent)
    elif isinstance(parent, ast.Call) and name in ALONE:
        for each in parent.args:
            if isinstance(each, ast.Call):
                yield Element(node=each, function=function, parent=parent)
    elif isinstance(parent, ast.Dict):
        for value in parent.values:
            if isinstance(value, ast.Call):
                yield Element(node=value, function=function, parent=parent)
    elif isinstance(parent, ast.Return) and isinstance(parent.value, ast.Call):
        yield Element(node=parent.value, function=function, parent=parent)


def _assigned(role: str, statement: ast.stmt) -> str | None:
    """The variable that a statement gives the device in a role."""
    if not isinstance(statement, ast.Assign) or called(statement.value) not in ("device", "devices"):
        return None
    target = statement.targets[0]
    names = target.elts if isinstance(target, ast.Tuple) else [target]
    assert isinstance(statement.value, ast.Call)
    for name, word in zip(names, statement.value.args, strict=False):
        if isinstance(name, ast.Name) and _names(word, role):
            return name.id
    return None


def _names(word: ast.expr, role: str) -> bool:
    if isinstance(word, ast.Constant):
        return word.value == role
    if isinstance(word, ast.JoinedStr) and word.values and isinstance(word.values[0], ast.Constant):
        return role.startswith(str(word.values[0].value))
    return False
