"""Reports that a plant has written by itself: bounded, one at a time, and never in its way."""

from __future__ import annotations

import logging
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.plant_file import loader
from arboleda.runtime.parts import reports
from arboleda.runtime.parts.reports import MOST_KEPT, MOST_WAITING, NoReport, ReportsPart

from ..patience import PATIENCE_S

SHIPPED = loader.load_recorded()[1]


def ended(task: str, state: TaskState = TaskState.FAILED, request: str | None = None) -> TaskChanged:
    return TaskChanged(task=task, text="sis_a 0B 7", cell="sis_a", state=state, request=request)


def running(code: str) -> Callable[[str, Path, Path], list[str]]:
    return lambda task, state, target: [sys.executable, "-c", code, task, str(target)]


def until(holds: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE_S
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.01)


NEVER_ENDS = "import os, signal, sys; print(os.getpid(), file=open(sys.argv[2], 'w', 1)); signal.pause()"
WRITES = "import sys; open(sys.argv[2], 'w').write('why'); print('the cause')"


def test_a_task_that_failed_gets_its_report_and_no_other_one(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.INFO)
    part = ReportsPart(tmp_path, running(WRITES), after_s=0.0)
    part.start()
    for change in (
        ended("done", TaskState.DONE),
        ended("again", request="asked for again"),
        ended("lot-1"),
        ended("lot-2"),
    ):
        part.changed(change)
    until(lambda: "why lot-2 failed: the cause" in caplog.text)
    part.stop()
    part.stop()
    folder = tmp_path / reports.FOLDER
    assert sorted(path.name for path in folder.iterdir()) == ["lot-1.html", "lot-2.html"]
    assert (folder / "lot-1.html").stat().st_mode & 0o077 == 0


def test_a_report_that_cannot_be_made_is_a_line_in_the_log(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    part = ReportsPart(tmp_path, running("import sys; print('a\\nno record'); sys.exit(2)"), after_s=0.0)
    part.start()
    part.changed(ended("lot"))
    until(lambda: "no report of lot: no record" in caplog.text)
    part.stop()


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


def test_why_there_is_no_report_is_said_once_and_then_it_is_tried_again(tmp_path: Path) -> None:
    part = ReportsPart(tmp_path, running("import sys; print('arboleda: no record'); sys.exit(2)"))
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


def test_what_is_no_task_and_one_too_many_are_refused(tmp_path: Path) -> None:
    part = ReportsPart(tmp_path, running(WRITES))
    for name in ("", "../tokens", "a/b", "x" * 65):
        with pytest.raises(NoReport, match="is not the id of a task"):
            part.report(name)
    for number in range(MOST_WAITING):
        assert part.report(f"lot-{number}") is None
    assert part.report("lot-0") is None, "it waits already"
    with pytest.raises(NoReport, match="20 other reports wait"):
        part.report("one-more")


def test_the_oldest_reports_go(tmp_path: Path) -> None:
    folder = tmp_path / reports.FOLDER
    folder.mkdir()
    for number in range(MOST_KEPT + 5):
        (folder / f"old-{number}.html").write_text("")
    part = ReportsPart(tmp_path, running(WRITES), after_s=0.0)
    part.start()
    part.changed(ended("lot"))
    until(lambda: (folder / "lot.html").exists())
    part.stop()
    assert len(list(folder.iterdir())) == MOST_KEPT


@pytest.mark.parametrize(("text", "expected"), [("", False), ("reports: off", False), ("reports: on", True)])
def test_reports_are_as_the_plant_file_says(tmp_path: Path, text: str, expected: bool) -> None:
    assert SHIPPED is not None
    file = tmp_path / "plant.yaml"
    file.write_bytes(SHIPPED.files.contents["plant.yaml"] + f"\n{text}\n".encode())
    recording = loader.load_recorded(file)[1]
    assert recording is not None and recording.reports is expected


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("reports: yes", "reports: "),
        ("record: off\nreports: on", "reports are made of the record, which is off"),
    ],
)
def test_wrong_reports_are_a_problem_of_the_plant_file(text: str, problem: str) -> None:
    assert SHIPPED is not None
    with pytest.raises(ConfigError, match=problem):
        loader.parse("p.yaml", SHIPPED.files.contents["plant.yaml"] + f"\n{text}\n".encode())
