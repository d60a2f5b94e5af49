"""The bugs of the engine stand where they are planted: their text is there once, and becomes other Python."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from ...mutants.engine_bug import EngineBug, bug
from ...mutants.engine_bugs import ENGINE_BUGS
from ...mutants.planted_engine import BugSources, nearest, sample

ROOT = Path(__file__).parents[4]
SOURCES = BugSources(ROOT)


@cache
def text_of(file: str) -> str:
    return SOURCES.path(file).read_text(encoding="utf-8")


@pytest.mark.parametrize("planted", ENGINE_BUGS, ids=lambda planted: planted.about[:60])
def test_a_bug_is_an_edit_of_what_stands_there(planted: EngineBug) -> None:
    text = text_of(planted.file)
    edited = planted.edited(text)
    assert edited != text
    compile(edited, planted.file, "exec", dont_inherit=True)


def test_each_bug_is_another_one() -> None:
    assert len({planted.key for planted in ENGINE_BUGS}) == len(ENGINE_BUGS) >= 100


def test_a_larger_sample_has_all_of_a_smaller_one() -> None:
    assert sample(12)[:5] == sample(5)
    assert len(sample(None)) == len(ENGINE_BUGS)


def test_a_bug_is_looked_for_in_the_lines_of_its_statement() -> None:
    text = "def f(a):\n    if (\n        a\n        and a > 1\n    ):\n        return 2\n    return 3\n"
    assert bug("f.py", "wrong", "a > 1", "a > 2").lines(text) == (2, 4)


def test_the_nearest_tests_of_a_file_are_those_of_its_layer_first_those_that_import_it() -> None:
    files = nearest("dispatch/zones.py")
    assert {Path(file).parent.as_posix() for file in files[:3]} == {"tests/unit/dispatch"}
    assert "zones" in (ROOT / files[0]).read_text(encoding="utf-8")
    assert Path(files[-1]).parent.as_posix() == "tests/scenario"
