"""`make check`: it goes on where it was interrupted, and says how every job ended."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from ..scripts import load

pytestmark = pytest.mark.system


@pytest.fixture
def check(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The script, in a repository of its own whose jobs write into `ran` and fail while `broken` is there."""
    script = load("check")
    root = tmp_path / "checkout"
    (root / "tests").mkdir(parents=True)
    (root / "file").write_text("as it was")
    (root / ".gitignore").write_text("/.check/\n/ran\n/broken\n")
    for words in (
        ["init", "-q"],
        ["add", "-A"],
        ["-c", "user.name=n", "-c", "user.email=e", "commit", "-qm", "m"],
    ):
        subprocess.run(["git", *words], cwd=root, check=True)
    jobs = (
        script.Job(name="good", command="echo good >>ran"),
        script.Job(name="bad", command="echo bad >>ran; ! test -e broken", whole="echo all >>ran"),
        script.Job(name="lucky", command=f"echo lucky >>ran; echo 'x: {script.SECOND_TRY}'"),
    )
    monkeypatch.setattr(script, "ROOT", root)
    monkeypatch.setattr(script, "FOLDER", root / ".check")
    monkeypatch.setattr(script, "JOBS", jobs)
    return script


def run(check: Any, monkeypatch: pytest.MonkeyPatch, *words: str) -> tuple[int, list[str]]:
    """Its status, and the jobs that ran."""
    ran = check.ROOT / "ran"
    ran.write_text("")
    monkeypatch.setattr(sys, "argv", ["check", *words])
    return check.main(), ran.read_text().split()


def test_all_run_though_one_fails_and_only_that_one_runs_again(
    check: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (check.ROOT / "broken").touch()
    assert run(check, monkeypatch) == (1, ["good", "bad", "lucky"])
    assert "check: FAILED: bad" in capsys.readouterr().out
    (check.ROOT / "broken").unlink()
    assert run(check, monkeypatch) == (0, ["bad"])


def test_other_files_are_tested_anew_and_a_row_of_a_second_try_is_none(
    check: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    run(check, monkeypatch)
    (check.ROOT / check.LEDGER).write_text("a row\n")
    subprocess.run(["git", "add", "-A"], cwd=check.ROOT, check=True)
    assert run(check, monkeypatch) == (0, [])
    (check.ROOT / "file").write_text("as it is")
    assert run(check, monkeypatch) == (0, ["good", "bad", "lucky"])


def test_jobs_are_named_and_have_a_long_form(check: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    assert run(check, monkeypatch, "bad", "good") == (0, ["bad", "good"])
    assert run(check, monkeypatch, "--whole", "bad") == (0, ["all"])


def test_what_is_left_and_the_second_tries_are_said(
    check: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    run(check, monkeypatch)
    said = capsys.readouterr().out
    assert "check: bad, 2 of 3, about 1 min; with what is left about 2 min" in said
    [lucky] = [line for line in said.splitlines() if line.startswith("lucky ")]
    assert lucky.split()[1] == "passed" and lucky.split()[-1] == "1"


def test_more_than_three_second_tries_in_all_jobs_are_too_many(
    check: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    (lucky,) = (job for job in check.JOBS if job.name == "lucky")
    jobs = [check.Job(name=f"{lucky.name}{number}", command=lucky.command) for number in range(4)]
    monkeypatch.setattr(check, "JOBS", jobs[:3])
    assert run(check, monkeypatch)[0] == 0
    monkeypatch.setattr(check, "JOBS", jobs)
    assert run(check, monkeypatch)[0] == 1


@pytest.mark.parametrize(
    ("name", "tests"),
    [("tests", "tests"), ("ur", "--about ur tests packages/*/tests tools/tests firmware/test")],
    ids=["folder", "word"],
)
def test_any_tests_are_a_job(check: Any, name: str, tests: str) -> None:
    assert check.job_named(name).command.endswith(f" {tests}")
