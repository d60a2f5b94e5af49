"""Finds every mutant of a file, and makes one of them: the tree of the file with that one change."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from .mutant import Mutant
from .operators import Change, Enums, changes

BODIES = ("body", "orelse", "finalbody", "handlers")
UNSEEN = {"annotation", "returns", "decorator_list", "bases", "keywords", "type_comment", "format_spec"}


@dataclass
class Place:
    """Place of a node in its tree: another node may stand there instead."""

    node: ast.AST
    parent: ast.AST
    field: str
    index: int | None
    function: str
    statement: ast.stmt

    def put(self, new: ast.AST) -> None:
        """Change the tree; what is new stands in the lines of what it replaces."""
        for node in ast.walk(new):
            if not hasattr(node, "lineno") and hasattr(self.node, "lineno"):
                ast.copy_location(node, self.node)
        if self.index is None:
            setattr(self.parent, self.field, new)
        else:
            getattr(self.parent, self.field)[self.index] = new


def mutants(file: str, source: str, enums: Enums) -> list[Mutant]:
    """Every mutant of a file, in the order of its text."""
    counts: Counter[tuple[str, ...]] = Counter()
    found = []
    for number, (place, change) in enumerate(_all(ast.parse(source), enums)):
        mutant = _named(file, source, number, place, change, counts)
        found.append(mutant)
    return found


def mutated(source: str, enums: Enums, number: int) -> ast.Module:
    """The tree of a file with its change of that number."""
    tree = ast.parse(source)
    place, (_, new) = next(each for at, each in enumerate(_all(tree, enums)) if at == number)
    place.put(new)
    return ast.fix_missing_locations(tree)


def enumerations(sources: list[str]) -> dict[str, tuple[str, ...]]:
    """The members of every enumeration that these files define."""
    return {
        node.name: tuple(name for each in node.body if (name := _member(each)))
        for source in sources
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.ClassDef) and any(getattr(base, "id", "") == "Enum" for base in node.bases)
    }


def _member(node: ast.stmt) -> str:
    """The name that a statement gives to a member of its enumeration, "" where it gives none."""
    first = node.targets[0] if isinstance(node, ast.Assign) else None
    return first.id if isinstance(first, ast.Name) else ""


def _all(tree: ast.Module, enums: Enums) -> Iterator[tuple[Place, Change]]:
    for place in _places(tree, "", None):
        for change in changes(place.node, enums):
            yield place, change


def _places(parent: ast.AST, function: str, statement: ast.stmt | None) -> Iterator[Place]:
    """Every node below that may be changed; neither annotations nor assertions, nor the lists of names."""
    for field, value in ast.iter_fields(parent):
        if field in UNSEEN and not (field == "keywords" and isinstance(parent, ast.Call)):
            continue
        if isinstance(parent, ast.keyword) and parent.arg == "strict":
            continue  # a check of ourselves, as an assertion is
        for index, node in enumerate(value) if isinstance(value, list) else [(None, value)]:
            if not isinstance(node, ast.AST) or _is_left_alone(node):
                continue
            inside = node if isinstance(node, ast.stmt) else statement
            if inside is not None:
                yield Place(node, parent, field, index, function, inside)
            yield from _places(node, _within(function, node), inside)


def _is_left_alone(node: ast.AST) -> bool:
    if isinstance(node, ast.Assign):
        names = [target.id for target in node.targets if isinstance(target, ast.Name)]
        return names == ["__all__"] or (bool(names) and _is_alias(node.value))
    return isinstance(node, ast.Assert | ast.Import | ast.ImportFrom)


def _is_alias(node: ast.expr) -> bool:
    """True if this is a type under another name."""
    while isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitOr):
        node = node.left
    root = node.value if isinstance(node, ast.Subscript) else node
    return isinstance(root, ast.Name) and root.id[0].isupper() and not root.id.isupper()


def _within(function: str, node: ast.AST) -> str:
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return f"{function}.{node.name}" if function else node.name
    return function


def _named(
    file: str,
    source: str,
    number: int,
    place: Place,
    change: Change,
    counts: Counter[tuple[str, ...]],
) -> Mutant:
    operator, new = change
    old_text, new_text, at = _texts(source, place, operator, new)
    same = (place.function, operator.split()[0], old_text, new_text)
    counts[same] += 1
    removed, added = _lines(source, at, new_text)
    begin = place.statement.lineno
    return Mutant(
        file=file,
        function=place.function,
        operator=operator.split()[0],
        old=old_text,
        new=new_text,
        nth=counts[same],
        number=number,
        line=at[0],
        lines=(begin, max(begin, _end(place.statement))),
        removed=removed,
        added=added,
    )


Span = tuple[int, int, int, int]  # first line, column in bytes, last line, column in bytes


def _texts(source: str, place: Place, operator: str, new: ast.AST) -> tuple[str, str, Span]:
    """The text there, the new one, and the span in the source."""
    node: ast.AST = place.node
    if operator.startswith("row"):
        first, last = _row(node, int(operator.split()[1]) - 1)
        span = (*_span(first)[:2], *_span(last)[2:])
        return _between(source, span), "", span
    if isinstance(node, ast.If | ast.IfExp | ast.While):
        node, new = node.test, new.test  # type: ignore[attr-defined]
    if isinstance(node, ast.comprehension):
        whole = place.parent
        old = ast.unparse(node).strip()
        return old, ast.unparse(new).strip(), _span(whole)
    return _between(source, _span(node)), ast.unparse(new), _span(node)


def _row(node: ast.AST, index: int) -> tuple[ast.AST, ast.AST]:
    """The first and the last node of a row of a set or a dict."""
    if isinstance(node, ast.Set):
        return node.elts[index], node.elts[index]
    assert isinstance(node, ast.Dict)
    return node.keys[index] or node.values[index], node.values[index]


@lru_cache(maxsize=1)
def _split(source: str) -> tuple[bytes, ...]:
    return tuple(source.encode().split(b"\n"))


def _between(source: str, span: Span) -> str:
    first, begin, last, end = span
    lines = list(_split(source)[first - 1 : last])
    lines[-1] = lines[-1][:end]
    lines[0] = lines[0][begin:]
    return b"\n".join(lines).decode()


def _span(node: ast.AST) -> Span:
    return (node.lineno, node.col_offset, node.end_lineno, node.end_col_offset)  # type: ignore[attr-defined]


def _lines(source: str, span: Span, new: str) -> tuple[str, str]:
    """The lines that change, before and after."""
    first, begin, last, end = span
    lines = _split(source)
    head, tail = lines[first - 1][:begin], lines[last - 1][end:]
    removed = b"\n".join(lines[first - 1 : last]).decode()
    return removed, head.decode() + new + tail.decode()


def _end(statement: ast.stmt) -> int:
    """The last line of a statement, of one with a body that of its head."""
    bodies = [getattr(statement, field, None) for field in BODIES]
    heads = [body[0].lineno - 1 for body in bodies if isinstance(body, list) and body]
    return min(heads) if heads else (statement.end_lineno or statement.lineno)
