"""Mutants: what is changed, under which name, and that the rest of the file stays as it was."""

from __future__ import annotations

import ast

import pytest

from arboleda_mutation import trees

ENUMS = {"Mode": ("CLEAR", "LATCH", "HALT")}


def changed(source: str) -> set[tuple[str, str, str]]:
    """(operator, before, after) of every mutant."""
    return {(each.operator, each.old, each.new) for each in trees.mutants("core/x.py", source, ENUMS)}


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("x = a < b", ("comparison", "a < b", "a <= b")),
        ("x = a is None", ("comparison", "a is None", "a is not None")),
        ("x = a in b", ("comparison", "a in b", "a not in b")),
        ("x = a and b", ("and-or", "a and b", "a or b")),
        ("x = a and b and c", ("part-left-out", "a and b and c", "a and c")),
        ("x = not a", ("sign", "not a", "a")),
        ("x = a + b", ("arithmetic", "a + b", "a - b")),
        ("x += 1", ("left-out", "x += 1", "pass")),
        ("x = f(3)", ("constant", "3", "4")),
        ("x = f(True)", ("constant", "True", "False")),
        ("x = f(0.5)", ("constant", "0.5", "1.0")),
        ("x = min(a)", ("call", "min(a)", "max(a)")),
        ("x = Mode.LATCH", ("member", "Mode.LATCH", "Mode.HALT")),
        ("x = {1: a, 2: b}", ("row", "2: b", "")),
        ("x = a if b else c", ("condition", "b", "not b")),
        ("if a:\n    f()", ("condition", "a", "not a")),
        ("x = [a for a in b if a]", ("filter", "for a in b if a", "for a in b")),
        ("self.x = 1", ("left-out", "self.x = 1", "pass")),
        ("def f():\n    return a", ("return", "return a", "return None")),
        ("for a in b:\n    continue", ("loop", "continue", "break")),
        ("raise a", ("left-out", "raise a", "pass")),
    ],
)
def test_an_operator_makes_its_slip(source: str, expected: tuple[str, str, str]) -> None:
    assert expected in changed(source)


@pytest.mark.parametrize(
    "source",
    [
        '"""Words."""',
        'x = "a word"',
        "Named = int | None",
        "def f(x: Mode = None) -> Mode | None: ...",
        "@cache(maxsize=3)\ndef f(): ...",
        "assert a < b",
        "x = zip(a, b, strict=True)",
        "x: Mode",
        "x = isinstance(a, int | Mode)",
    ],
)
def test_words_types_and_checks_of_ourselves_are_left_alone(source: str) -> None:
    assert changed(source) == set()


SOURCE = """
class Latch:
    def look(self, a, b):
        if a < b and a < b:
            self.on = True
        return a
"""


def test_only_the_one_place_changes() -> None:
    for mutant in trees.mutants("core/x.py", SOURCE, ENUMS):
        made = ast.unparse(trees.mutated(SOURCE, ENUMS, mutant.number)).splitlines()
        before = ast.unparse(ast.parse(SOURCE)).splitlines()
        assert len(made) == len(before)
        assert sum(new != old for new, old in zip(made, before, strict=True)) == 1


def test_a_key_says_which_one_it_is_and_outlives_moved_lines() -> None:
    keys = [each.key for each in trees.mutants("core/x.py", SOURCE, ENUMS)]
    assert "core/x.py::Latch.look::comparison::a < b -> a <= b::2" in keys
    assert len(set(keys)) == len(keys)
    moved = "import math\n\n\nX = math.pi\n" + SOURCE
    assert set(keys) <= {each.key for each in trees.mutants("core/x.py", moved, ENUMS)}


def test_a_person_reads_the_changed_line() -> None:
    mutant = next(each for each in trees.mutants("core/x.py", SOURCE, ENUMS) if each.operator == "and-or")
    assert (mutant.place, mutant.removed.strip(), mutant.added.strip()) == (
        "core/x.py:4",
        "if a < b and a < b:",
        "if a < b or a < b:",
    )


def test_members_of_enumerations_are_found() -> None:
    source = "class Mode(int, Enum):\n    CLEAR = 0\n    LATCH = 1\n\n\nclass Other:\n    A = 1\n"
    assert trees.enumerations([source]) == {"Mode": ("CLEAR", "LATCH")}
