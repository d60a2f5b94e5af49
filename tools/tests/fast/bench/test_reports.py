"""The wait for a report of a driver in benchmarks."""

from __future__ import annotations

import pytest

from arboleda.drivers import Report
from arboleda.model.errors import ArboledaError
from arboleda_bench.reports import Reports


def report(done: str = "") -> Report:
    return Report(robot="arm", at=0.0, done=done or None)


def test_reports_that_do_not_fit_are_passed_over() -> None:
    reports, seen = Reports(patience_s=60.0), list[str | None]()
    for done in ("", "c1", "c2"):
        reports.hear(report(done))

    def fits(each: Report) -> bool:
        seen.append(each.done)
        return each.done == "c1"

    reports.until(fits)
    assert seen == [None, "c1"]


def test_a_wait_ends_though_other_reports_keep_coming() -> None:
    reports = Reports(patience_s=0.001)
    reports.hear(report())

    def fits(each: Report) -> bool:
        reports.hear(each)
        return False

    with pytest.raises(ArboledaError, match="did not report what was waited for within"):
        reports.until(fits)
