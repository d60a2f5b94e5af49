"""Reports that a plant has written by itself: bounded, one at a time, and never in its way."""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from tests.patience import until

from arboleda.model.messages import TaskChanged, TaskState
from arboleda_proofs.running import reports_part as reports
from arboleda_proofs.running.reports_part import MOST_KEPT, MOST_WAITING, NoReport, ReportsPart


def ended(task: str, state: TaskState = TaskState.FAILED, request: str | None = None) -> TaskChanged:
    return TaskChanged(task=task, text="sis_a 0B 7", cell="sis_a", state=state, request=request)


def running(code: str) -> Callable[[str, Path, Path], list[str]]:
    return lambda task, state, target: [sys.executable, "-c", code, task, str(target)]


NEVER_ENDS = "import os, signal, sys; print(os.getpid(), file=open(sys.argv[2], 'w', 1)); signal.pause()"
WRITES = "import sys; open(sys.argv[2], 'w').write('why'); print('the cause')"


def test_a_task_that_failed_gets_its_report_and_no_other_one_and_the_oldest_go(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.INFO)
    folder = tmp_path / reports.FOLDER
    folder.mkdir()
    for number in range(MOST_KEPT + 5):
        (folder / f"old-{number}.html").write_text("")
    part = ReportsPart(tmp_path, running(WRITES), after_s=0.0)
    part.start()
    for change in (
        ended("done", TaskState.DONE),
        ended("again", request="asked for again"),
        ended("lot-1"),
        ended("lot-2"),
    ):
        part.changed(change)
    until(lambda: "report of lot-2: the cause" in caplog.text)
    part.stop()
    part.stop()
    made = [path.name for path in folder.iterdir()]
    assert sorted(name for name in made if "old" not in name) == ["lot-1.html", "lot-2.html"]
    assert len(made) == MOST_KEPT
    assert (folder / "lot-1.html").stat().st_mode & 0o077 == 0


def test_only_so_many_wait_and_the_end_of_the_plant_waits_for_none(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    part = ReportsPart(tmp_path, running(NEVER_ENDS), after_s=0.0)
    for number in range(MOST_WAITING + 2):
        part.changed(ended(f"lot-{number}"))
    assert caplog.text.count("others wait") == 2
    part.start()
    said = tmp_path / reports.FOLDER / "lot-0.part"
    until(lambda: said.exists() and said.read_text().endswith("\n"))
    process = int(said.read_text())
    part.stop()
    with pytest.raises(ProcessLookupError):
        os.kill(process, 0)
    assert not list((tmp_path / reports.FOLDER).iterdir()), "half a report is none"
    assert "no report of lot-0" not in caplog.text, "nothing went wrong with what was ended"


def test_a_report_that_is_asked_for_is_written_before_those_that_wait_for_their_record(
    tmp_path: Path,
) -> None:
    part = ReportsPart(tmp_path, running(WRITES), after_s=3600.0)
    part.start()
    part.changed(ended("other"))
    assert part.report("lot") is None
    until(lambda: part.report("lot") == "why")
    part.stop()
    assert [path.name for path in (tmp_path / reports.FOLDER).iterdir()] == ["lot.html"]


def test_why_there_is_no_report_is_said_once_and_then_it_is_tried_again(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    part = ReportsPart(tmp_path, running("import sys; print('a\\narboleda: no record'); sys.exit(2)"))
    part.start()
    said: list[str] = []

    def refused() -> bool:
        try:
            assert part.report("lot") is None
        except NoReport as objection:
            said.append(str(objection))
        return len(said) == 2

    until(refused)
    part.stop()
    assert said == ["no record"] * 2
    assert "no report of lot: no record" in caplog.text
