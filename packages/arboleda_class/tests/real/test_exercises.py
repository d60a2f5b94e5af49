"""Works of exercises are judged in a process of their own, and told as a table and as stories."""

from __future__ import annotations

import json
from pathlib import Path

from exercises.works import handed_in
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda_class.exercises import judge_process
from arboleda_class.exercises.exercise import exercise
from arboleda_class.exercises.work import Work

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
    assert [each.says["en"] for each in verdict.findings] == ["The work can be judged"]


def check(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(cli, ["exercise", *arguments], env={"ARBOLEDA_LANG": "", "LANG": "C"})
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
