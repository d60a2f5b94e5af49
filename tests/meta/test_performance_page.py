"""The page of figures: one run of one revision, all of it, and what falls short is marked so."""

from __future__ import annotations

import json
import re
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from arboleda_bench import catalog, page

DOCS = Path(__file__).parents[2] / "docs"
LONGEST_RUN = timedelta(hours=1)
NUMBER = re.compile(r"(<=|>=) ([\d.]+)(x?)")


@pytest.fixture(scope="module")
def run() -> dict[str, Any]:
    made: dict[str, Any] = json.loads((DOCS / "performance.json").read_text("utf-8"))
    return made


@pytest.fixture(scope="module")
def text() -> str:
    return (DOCS / "performance.md").read_text("utf-8")


def reaches(figure: dict[str, Any]) -> bool | None:
    """Whether the figure reaches its aim, from the numbers alone; None without an aim or a floor."""
    found = NUMBER.fullmatch(figure["aim"] or "")
    if found is None:
        return None
    sign, bound, of_ratio = found.groups()
    value = figure["ours"] / figure["floor"] if of_ratio else figure["ours"]
    return bool(value <= float(bound) if sign == "<=" else value >= float(bound))


def test_the_figures_are_those_of_the_run_and_nobody_has_changed_them(run: dict[str, Any], text: str) -> None:
    assert page.filled(text, run) == text


def test_no_row_is_older_than_another(run: dict[str, Any]) -> None:
    benches = run["benches"].values()
    began = [datetime.fromisoformat(bench["began"]) for bench in benches]
    assert {bench["revision"] for bench in benches} == {next(iter(benches))["revision"]}
    assert began == sorted(began) and began[-1] - began[0] < LONGEST_RUN
    assert began[0].date().isoformat() == run["date"]


def test_what_was_measured_is_a_commit(run: dict[str, Any]) -> None:
    assert all(re.fullmatch("[0-9a-f]{12}", bench["revision"]) for bench in run["benches"].values())


def test_every_benchmark_is_there_or_is_said_to_be_missing(run: dict[str, Any], text: str) -> None:
    assert {*run["benches"], *run["not_measured"]} == set(catalog.NAMES)
    assert all(f"`{name}` was not measured: " in text for name in run["not_measured"])


def test_what_falls_short_is_marked_so(run: dict[str, Any], text: str) -> None:
    rows = [
        line.split(" | ") for line in text.splitlines() if line.startswith("| `") and line.count("|") == 8
    ]
    marks = {(cells[0].strip("| `"), cells[1]): cells[-1].strip(" |") for cells in rows}
    for name, bench in run["benches"].items():
        for figure in bench["figures"]:
            reached = reaches(figure)
            assert figure["reached"] is reached
        for figure in page.shown(bench["figures"]):
            assert marks[name, figure["name"]] == page.REACHED[figure["reached"]]


@pytest.mark.parametrize("revision", ["0123456789ab", "0123456789ab+"])
def test_a_row_of_another_revision_is_named_in_the_heading(run: dict[str, Any], revision: str) -> None:
    mixed = json.loads(json.dumps(run))
    next(iter(mixed["benches"].values()))["revision"] = revision
    assert revision in page.block(mixed).splitlines()[0]


def test_a_page_without_a_place_for_figures_is_refused(run: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="it has no lines"):
        page.filled("# Performance\n", run)
