"""Exercises: what belongs to each, and how their judge finds; all of their works are in tests/exercises."""

from __future__ import annotations

import json
from pathlib import Path

from typer.testing import CliRunner

from arboleda.campaigns.exercises import judge_process
from arboleda.campaigns.exercises.exercise import exercise
from arboleda.campaigns.exercises.work import SHEET, Work
from arboleda.cli.main import cli

from ..exercises.works import Sample, samples

FOREVER = """
import sys
from arboleda.recipes import recipe, work

@recipe("top_up")
def top_up(cell):
    \"\"\"Top up a bottle.\"\"\"
    if "arboleda.campaigns.exercises.judge_process" in sys.modules:
        import os
        print('{"passes": true, "asked": 1, "runs": 1, "findings": []}', flush=True)
        os._exit(0)
    return work(cell.device("scale").weigh())
"""


def two(name: str) -> list[Sample]:
    """The first right work of an exercise, and the first wrong one that is not its beginning."""
    known = list(samples(name))
    return [next(each for each in known if each.right), [each for each in known if not each.right][1]]


def handed_in(folder: Path, name: str, student: str) -> Path:
    """The first right work of an exercise as a folder of a student."""
    made = folder / student / name
    made.mkdir(parents=True)
    (made / SHEET).write_text(f"exercise: {name}\nstudent: {student}\n", "utf-8")
    for called, content in two(name)[0].files.items():
        (made / called).write_bytes(content)
    return made


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
