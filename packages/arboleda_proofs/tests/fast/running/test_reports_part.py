"""Reports that are asked for before a plant writes any, and whether a plant writes them by itself."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader
from arboleda_proofs.running.reports_part import FOLDER, MOST_WAITING, NoReport, ReportsPart

SHIPPED = loader.load_recorded()[1]


@pytest.mark.parametrize("name", ["", "../tokens", "a/b", "x" * 65])
def test_what_is_no_task_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(NoReport, match="is not the id of a task"):
        ReportsPart(tmp_path).report(name)


def test_one_too_many_is_refused(tmp_path: Path) -> None:
    part = ReportsPart(tmp_path)
    for number in range(MOST_WAITING):
        assert part.report(f"lot-{number}") is None
    assert part.report("lot-0") is None, "it waits already"
    with pytest.raises(NoReport, match="20 other reports wait"):
        part.report("one-more")


def test_a_report_that_is_there_is_written_anew_once_a_package_wrote_about_its_task(tmp_path: Path) -> None:
    part = ReportsPart(tmp_path)
    part.wrote("lot")
    part.wrote("../lot")
    (tmp_path / FOLDER).mkdir()
    (tmp_path / FOLDER / "old.html").write_text("old")
    part.wrote("old")
    for number in range(MOST_WAITING - 1):
        assert part.report(f"lot-{number}") is None
    assert part.report("old") == "old", "until it is written"
    with pytest.raises(NoReport, match="20 other reports wait"):
        part.report("one-more")


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
