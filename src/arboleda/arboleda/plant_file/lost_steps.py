"""Steps that a recipe makes and that stand in no other step, so that nobody ever does them.

A step that a statement makes and does not use is lost for certain. A step that gets a name may be used with
other parameters.
"""

from __future__ import annotations

import ast
import sys
from dataclasses import dataclass, field

from py_trees.behaviour import Behaviour

KEEP = "__made_by_a_statement__"  # function that a statement calls with its value, in a file that is tried
NAME = "__made_with_a_name__"  # function that an assignment calls with its value and its name


@dataclass(frozen=True, kw_only=True)
class Made:
    """A step, and where it was made; `name` is "" for a step that no variable has."""

    step: Behaviour
    file: str
    line: int
    name: str = ""

    @property
    def is_lost(self) -> bool:
        """True if the step stands in no other step."""
        return self.step.parent is None and not getattr(self.step, "is_taken", False)


@dataclass
class LostSteps:
    """Notes the steps that statements and assignments of a user's files make, while a recipe is built."""

    made: list[Made] = field(default_factory=list)

    def note(self, value: object, name: str = "") -> object:
        """Note a step, and return it. A statement passes its value, an assignment its value and its name."""
        if isinstance(value, Behaviour):
            frame = sys._getframe(1)
            code = frame.f_code
            self.made.append(Made(step=value, file=code.co_filename, line=frame.f_lineno, name=name))
        return value

    def lost(self) -> list[Made]:
        """The steps without a name that stand in no other step."""
        return [each for each in self.made if each.is_lost and not each.name]


class _Noting(ast.NodeTransformer):
    def visit_Expr(self, node: ast.Expr) -> ast.Expr:
        if isinstance(node.value, ast.Call):
            node.value = _passed_on(KEEP, node.value)
        return node

    def visit_Assign(self, node: ast.Assign) -> ast.Assign:
        if isinstance(node.value, ast.Call) and isinstance(node.targets[0], ast.Name):
            node.value = _passed_on(NAME, node.value, ast.Constant(node.targets[0].id))
        return node


def _passed_on(function: str, value: ast.expr, *more: ast.expr) -> ast.expr:
    called = ast.Call(func=ast.Name(id=function, ctx=ast.Load()), args=[value, *more], keywords=[])
    return ast.copy_location(called, value)


def noting(tree: ast.Module) -> ast.Module:
    """The program, in which statements and assignments pass each step to `LostSteps.note`."""
    return ast.fix_missing_locations(_Noting().visit(tree))  # type: ignore[no-any-return]
