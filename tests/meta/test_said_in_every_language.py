"""What commands print is said in every language: no sentence stands in the code that has no twin."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.packages import PACKAGES

CLI = Path(__file__).parents[2] / "src/arboleda/arboleda/cli"
NO_SENTENCES = {"service_unit.py"}  # it writes a file for another program
SAYING = {"print", "echo", "confirm", "status", "add_column", "Text", "BadParameter"}
WORD = re.compile(r"\b[A-Za-z]{2,}\b")
VERBATIM = re.compile(r"(\s*\{\}\n)?\s*\{\} (exercise|up|replay) |MCP: http:")  # to be typed, or an address


def said(path: Path) -> Iterator[tuple[int, str]]:
    """The sentences that a file hands to what prints them, or to an error: line and text."""
    tree = ast.parse(path.read_text("utf-8"))
    raised = [each.exc for each in ast.walk(tree) if isinstance(each, ast.Raise)]
    for call in ast.walk(tree):
        if not isinstance(call, ast.Call) or not (call in raised or _says(_name(call.func))):
            continue
        for each in (*call.args, *(keyword.value for keyword in call.keywords)):
            yield from ((call.lineno, text) for text in _texts(each) if _is_sentence(text))


def _says(name: str) -> bool:
    return name in SAYING or name.endswith("Error")


def _is_sentence(text: str) -> bool:
    return len(WORD.findall(text)) > 1 and not VERBATIM.match(text)


def _name(of: ast.expr) -> str:
    return of.attr if isinstance(of, ast.Attribute) else of.id if isinstance(of, ast.Name) else ""


def _texts(of: ast.expr) -> Iterator[str]:
    """The texts in an expression, but for those that are handed on to something else."""
    if isinstance(of, ast.Constant) and isinstance(of.value, str):
        yield of.value
    elif isinstance(of, ast.JoinedStr):
        yield "".join(str(part.value) if isinstance(part, ast.Constant) else "{}" for part in of.values)
    elif not isinstance(of, ast.Call):
        for each in ast.iter_child_nodes(of):
            yield from _texts(each) if isinstance(each, ast.expr) else ()


FILES = [
    *sorted(path for path in CLI.glob("*.py") if path.name not in NO_SENTENCES),
    *(
        path
        for code in PACKAGES.values()
        for path in sorted([*code.rglob("command.py"), *code.glob("commands/[a-z]*.py")])
    ),
]


@pytest.mark.parametrize("file", FILES, ids=lambda file: f"{file.parent.name}-{file.stem}")
def test_a_command_prints_phrases_and_no_sentences_of_its_own(file: Path) -> None:
    assert list(said(file)) == [], "make a Phrase of each, and say it: cli/language.py"


def test_a_sentence_is_found(tmp_path: Path) -> None:
    file = tmp_path / "some.py"
    file.write_text(
        'print(f"wrote {name} again")\nraise StartError("no such thing")\nprint(say(X(a="b c d")))\n'
        'raise Nobody("is here")\n'
    )
    assert list(said(file)) == [(1, "wrote {} again"), (2, "no such thing"), (4, "is here")]
