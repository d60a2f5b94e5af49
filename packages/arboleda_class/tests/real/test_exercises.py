"""Works of exercises are judged in a process of their own, and told as a table and as stories."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import pytest
from tests.tutorial_pages import ROOT, commands, differs
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda_class.exercises import judge_process
from arboleda_class.exercises.exercise import exercise
from arboleda_class.exercises.work import Work

from ..exercises.works import handed_in, samples

FOREVER = """
import sys
from arboleda.recipes import recipe, work

@recipe("top_up")
def top_up(cell):
    \"\"\"Top up a bottle.\"\"\"
    if "arboleda_class.exercises.judge_process" in sys.modules:
        import os
        print('{"passes": true, "asked": 1, "runs": 1, "findings": []}', flush=True)
        os._exit(0)
    return work(cell.device("scale").weigh())
"""


def test_python_that_ends_the_judge_gets_no_verdict() -> None:
    work = Work(where=Path(), exercise="query_first", files={"recipes.py": FOREVER.encode()})
    verdict = judge_process.judged(work)
    assert not verdict.passes
    assert [each.says["en"] for each in verdict.findings] == ["The files are a plant"]  # its recipe is tried


def check(*arguments: str, language: str = "") -> tuple[int, str]:
    done = CliRunner().invoke(cli, ["exercise", *arguments], env={"ARBOLEDA_LANG": language, "LANG": "C"})
    return done.exit_code, done.output


def test_a_folder_of_works_is_a_table_with_a_record_of_what_went_wrong(tmp_path: Path) -> None:
    handed_in(tmp_path / "in", "query_first", "Ana")
    wrong = handed_in(tmp_path / "in", "query_first", "Bea")
    (wrong / "recipes.py").write_bytes(exercise("query_first").start["recipes.py"])
    told, stories = tmp_path / "told.json", tmp_path / "stories"
    status, output = check("check", str(tmp_path / "in"), "--json", str(told), "--stories", str(stories))
    assert status == 1 and "1 / 2: passes" in output
    rows = json.loads(told.read_text("utf-8"))["works"]
    assert [(row["student"], row["passes"]) for row in rows] == [("Ana", True), ("Bea", False)]
    assert [each.name for each in stories.iterdir()] == ["002-query_first-Bea.mcap"]


def test_a_work_of_ones_own_is_told_with_its_story(tmp_path: Path) -> None:
    folder = tmp_path / "retry"
    check("start", "retry", str(folder))
    status, output = check("check", str(folder), "--lang", "es")
    assert status == 1 and "aún no aprueba" in output and "camera look" in output
    assert (folder / "story.mcap").stat().st_size > 1000


@pytest.mark.parametrize(("language", "page"), [("en", "exercises.md"), ("es", "exercises.es.md")])
def test_the_commands_of_the_page_print_what_it_says(
    language: str, page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["arboleda"])
    handed_in(tmp_path / "handed-in", "retry", "Ana")
    bea = handed_in(tmp_path / "handed-in", "retry", "Bea")
    [many] = [each for each in samples("retry") if each.about == "far too many tries"]
    (bea / "recipes.py").write_bytes(many.files["recipes.py"])
    for command, expected in commands(ROOT / "docs/how-to" / page):
        program, group, *arguments = shlex.split(command)
        assert (program, group) == ("arboleda", "exercise")
        output = check(*arguments, language=language)[1]
        assert not (printed := differs(expected, output)), f"$ {command}\n{printed}"
