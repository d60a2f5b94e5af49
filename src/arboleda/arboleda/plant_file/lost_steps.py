"""Steps that a recipe makes in a statement of their own, where nothing takes them: nobody ever does them."""

from __future__ import annotations

import ast
import sys
from dataclasses import dataclass, field

from py_trees.behaviour import Behaviour

KEEP = "__made_by_a_statement__"  # function that a statement calls with its value, in a file that is tried


@dataclass
class LostSteps:
    """Notes the steps that statements of a user's files make, while a recipe is built."""

    made: list[tuple[Behaviour, str, int]] = field(default_factory=list)

    def note(self, value: object) -> object:
        """Called by a statement with its value."""
        if isinstance(value, Behaviour):
            frame = sys._getframe(1)
            self.made.append((value, frame.f_code.co_filename, frame.f_lineno))
        return value

    def lost(self) -> list[tuple[str, str, int]]:
        """The names of the steps that stand in no other one, with file and line."""
        made = [row for row in self.made if row[0].parent is None and not getattr(row[0], "is_taken", False)]
        return [(step.name, file, line) for step, file, line in made]


class _Noting(ast.NodeTransformer):
    def visit_Expr(self, node: ast.Expr) -> ast.Expr:
        if isinstance(node.value, ast.Call):
            called = ast.Call(func=ast.Name(id=KEEP, ctx=ast.Load()), args=[node.value], keywords=[])
            node.value = ast.copy_location(called, node.value)
        return node


def noting(tree: ast.Module) -> ast.Module:
    """The same program, whose statements pass on their values."""
    return ast.fix_missing_locations(_Noting().visit(tree))  # type: ignore[no-any-return]
