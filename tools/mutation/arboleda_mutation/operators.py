"""The operators: what a slip of the hand, or of the mind, makes of an expression or a statement.

Words are left alone: what a sentence says is for tests of words, and for its reader.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from copy import copy
from typing import Any

Enums = Mapping[str, tuple[str, ...]]  # the members of each enumeration, by its name
Change = tuple[str, ast.AST]  # the operator's name, and what stands there instead

COMPARISONS: dict[type, type] = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
SUMS: dict[type, type] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.BitOr: ast.BitAnd,
    ast.BitAnd: ast.BitOr,
}
TWINS = {"min": "max", "max": "min", "any": "all", "all": "any"}


def changes(node: ast.AST, enums: Enums) -> Iterator[Change]:
    """Everything that may stand there instead."""
    change = _OF.get(type(node))
    if change is not None:
        yield from change(node, enums)


def _compare(node: ast.Compare, enums: Enums) -> Iterator[Change]:
    for index, op in enumerate(node.ops):
        ops = list(node.ops)
        ops[index] = COMPARISONS[type(op)]()
        yield "comparison", ast.Compare(left=node.left, ops=ops, comparators=node.comparators)


def _both(node: ast.BoolOp, enums: Enums) -> Iterator[Change]:
    other = ast.Or() if isinstance(node.op, ast.And) else ast.And()
    yield "and-or", ast.BoolOp(op=other, values=node.values)
    for index in range(len(node.values)):
        rest = [value for place, value in enumerate(node.values) if place != index]
        yield "part-left-out", rest[0] if len(rest) == 1 else ast.BoolOp(op=node.op, values=rest)


def _negation(node: ast.UnaryOp, enums: Enums) -> Iterator[Change]:
    if isinstance(node.op, ast.Not | ast.USub):
        yield "sign", node.operand


def _sum(node: ast.BinOp, enums: Enums) -> Iterator[Change]:
    if type(node.op) in SUMS and not _is_type(node):
        yield "arithmetic", ast.BinOp(left=node.left, op=SUMS[type(node.op)](), right=node.right)


def _step(node: ast.AugAssign, enums: Enums) -> Iterator[Change]:
    if type(node.op) in SUMS:
        yield "arithmetic", ast.AugAssign(target=node.target, op=SUMS[type(node.op)](), value=node.value)
    yield "left-out", ast.Pass()


def _constant(node: ast.Constant, enums: Enums) -> Iterator[Change]:
    value = node.value
    if isinstance(value, bool):
        yield "constant", ast.Constant(value=not value)
    elif isinstance(value, int):
        yield "constant", ast.Constant(value=value + 1)
    elif isinstance(value, float):
        yield "constant", ast.Constant(value=value * 2 if value else 1.0)


def _call(node: ast.Call, enums: Enums) -> Iterator[Change]:
    if isinstance(node.func, ast.Name) and node.func.id in TWINS:
        other = ast.Name(id=TWINS[node.func.id], ctx=ast.Load())
        yield "call", ast.Call(func=other, args=node.args, keywords=node.keywords)


def _member(node: ast.Attribute, enums: Enums) -> Iterator[Change]:
    """The next member of the enumeration."""
    if isinstance(node.value, ast.Name) and node.attr in (members := enums.get(node.value.id, ())):
        following = members[(members.index(node.attr) + 1) % len(members)]
        yield "member", ast.Attribute(value=node.value, attr=following, ctx=node.ctx)


def _display(node: ast.Set | ast.Dict, enums: Enums) -> Iterator[Change]:
    """A row of a table is missing."""
    rows = node.elts if isinstance(node, ast.Set) else node.values
    for index in range(len(rows) if len(rows) > 1 else 0):
        left = [number for number in range(len(rows)) if number != index]
        if isinstance(node, ast.Set):
            yield f"row {index + 1}", ast.Set(elts=[node.elts[number] for number in left])
        else:
            keys = [node.keys[number] for number in left]
            yield f"row {index + 1}", ast.Dict(keys=keys, values=[node.values[number] for number in left])


def _condition(node: ast.If | ast.IfExp | ast.While, enums: Enums) -> Iterator[Change]:
    turned = copy(node)
    turned.test = ast.UnaryOp(op=ast.Not(), operand=turned.test)
    yield "condition", turned


def _filter(node: ast.comprehension, enums: Enums) -> Iterator[Change]:
    for index in range(len(node.ifs)):
        wider = copy(node)
        wider.ifs = [each for each in node.ifs if each is not node.ifs[index]]
        yield "filter", wider


def _statement(node: ast.Expr, enums: Enums) -> Iterator[Change]:
    if isinstance(node.value, ast.Call | ast.Yield | ast.YieldFrom):
        yield "left-out", ast.Pass()


def _assignment(node: ast.Assign, enums: Enums) -> Iterator[Change]:
    """To leave out what a name of the function is bound to is an error that no test could miss."""
    if any(isinstance(target, ast.Attribute | ast.Subscript) for target in node.targets):
        yield "left-out", ast.Pass()


def _left_out(node: ast.stmt, enums: Enums) -> Iterator[Change]:
    yield "left-out", ast.Pass()


def _return(node: ast.Return, enums: Enums) -> Iterator[Change]:
    if node.value is not None and not (isinstance(node.value, ast.Constant) and node.value.value is None):
        yield "return", ast.Return(value=ast.Constant(value=None))


def _loop_end(node: ast.Continue | ast.Break, enums: Enums) -> Iterator[Change]:
    yield "loop", ast.Break() if isinstance(node, ast.Continue) else ast.Continue()


def _is_type(node: ast.BinOp) -> bool:
    """True if `A | B` names a union of types, not a set."""
    names = [side for side in (node.left, node.right) if isinstance(side, ast.Name | ast.Constant)]
    return isinstance(node.op, ast.BitOr) and any(
        isinstance(name, ast.Constant) or name.id[0].isupper() for name in names
    )


_OF: dict[type, Callable[[Any, Enums], Iterator[Change]]] = {
    ast.Compare: _compare,
    ast.BoolOp: _both,
    ast.UnaryOp: _negation,
    ast.BinOp: _sum,
    ast.AugAssign: _step,
    ast.Constant: _constant,
    ast.Call: _call,
    ast.Attribute: _member,
    ast.Set: _display,
    ast.Dict: _display,
    ast.If: _condition,
    ast.IfExp: _condition,
    ast.While: _condition,
    ast.comprehension: _filter,
    ast.Expr: _statement,
    ast.Assign: _assignment,
    ast.Delete: _left_out,
    ast.Raise: _left_out,
    ast.Return: _return,
    ast.Continue: _loop_end,
    ast.Break: _loop_end,
}
