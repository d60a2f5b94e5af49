"""Reports start before the record, whose end they outlive, and a demonstration after the page."""

from __future__ import annotations

from pathlib import Path

from tests.unit.runtime.test_order_of_parts import names

from arboleda.runtime.demo_options import DemoOptions


def test_reports_start_right_before_the_record(tmp_path: Path) -> None:
    found = names(tmp_path)
    assert found[found.index("Recorder") - 1] == "ReportsPart"


def test_a_plant_that_keeps_no_record_has_no_reports(tmp_path: Path) -> None:
    assert "ReportsPart" not in names(tmp_path, recorded=False)


def test_a_demonstration_comes_after_the_page(tmp_path: Path) -> None:
    found = names(tmp_path, of_parts=(DemoOptions(),))
    assert found.index("DemoPart") > found.index("WebPart")
