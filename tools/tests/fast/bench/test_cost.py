"""The cost lock: a slowdown is caught and named, a cost counts the same twice, and the table is whole."""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import replace
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda_bench.cost import __main__ as command
from arboleda_bench.cost.scenarios import SCENARIOS, from_reports, moving_reports
from arboleda_bench.cost.table import FOLDER, Comparison, Cost, read, write

NAME = "step: a report of a moving arm"


def counted() -> Cost:
    return Cost.of(command.cost_of(partial(moving_reports, 1)))


def no_use(_report: object) -> None:
    """A call that does nothing."""


def test_the_same_work_costs_the_same_twice() -> None:
    assert counted() == counted()


def test_a_slowdown_is_caught_and_its_function_named(monkeypatch: pytest.MonkeyPatch) -> None:
    pinned, report = counted(), Dispatcher.report

    def slower(self: Dispatcher, *said: Any) -> None:
        for _ in range(3):
            no_use(said)
        report(self, *said)

    monkeypatch.setattr(Dispatcher, "report", slower)
    row = Comparison(name=NAME, pinned=pinned, now=counted())
    assert row.is_dearer
    assert any("no_use" in line for line in row.grown())


@pytest.mark.long
def test_a_busy_machine_does_not_change_the_count(monkeypatch: pytest.MonkeyPatch) -> None:
    quiet, hours = Cost.of(command.cost_of(from_reports)), count(step=3600.0)
    monkeypatch.setattr(time, "clock_gettime", lambda _clock: next(hours))
    now = Cost.of(command.cost_of(from_reports))
    assert not Comparison(name=NAME, pinned=quiet, now=now).is_dearer


def test_two_percent_more_are_allowed_and_three_are_not() -> None:
    pinned = Cost(calls=1000, different=100, functions={})
    rows = [
        Comparison(name=NAME, pinned=pinned, now=Cost(calls=calls, different=different, functions={}))
        for calls, different in ((970, 100), (1000, 100), (1020, 102), (1030, 100), (1000, 97), (1000, 103))
    ]
    assert [row.is_dearer for row in rows] == [False, False, False, True, False, True]
    assert [row.is_cheaper for row in rows] == [True, False, False, False, True, False]


def test_a_function_counts_once_in_each_act() -> None:
    cost = Cost.of([Counter({"a.py often": 10, "a.py rare": 1}), Counter({"a.py often": 3})])
    assert (cost.calls, cost.different) == (14, 3)


def test_a_scenario_without_a_pinned_cost_fails() -> None:
    assert Comparison(name=NAME, pinned=None, now=Cost(calls=1, different=1, functions={})).is_dearer


def test_a_function_that_was_too_rare_to_be_pinned_is_named_once_it_is_not() -> None:
    pinned = Cost.of([Counter({"a.py often": 10_000, "a.py rare": 1})])
    now = Cost.of([Counter({"a.py often": 10_000, "a.py rare": 500})])
    [line] = Comparison(name=NAME, pinned=pinned, now=now).grown()
    assert line == "500 calls, pinned at most 20: a.py rare"


def test_costs_are_read_as_they_were_written(tmp_path: Path) -> None:
    costs = {NAME: counted()}
    write(tmp_path / "table.json", costs)
    assert read(tmp_path / "table.json") == costs


def test_the_command_fails_for_what_is_dearer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / "table.json"
    monkeypatch.setattr(command, "file_for", lambda _python: table)
    monkeypatch.setattr("sys.argv", ["cost", "--only", NAME])
    cost = counted()
    write(table, {NAME: replace(cost, calls=cost.calls - 50)})
    assert command.main() == command.DEARER
    assert f"{NAME}: {cost.calls:,} calls" in capsys.readouterr().err
    write(table, {NAME: cost})
    assert command.main() == 0


def test_the_command_refuses_scenarios_that_are_not_there_and_tables_that_are_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(command, "file_for", lambda _python: tmp_path / "none.json")
    monkeypatch.setattr("sys.argv", ["cost", "--only", "no such scenario"])
    assert command.main() == command.UNUSABLE
    assert NAME in capsys.readouterr().err
    monkeypatch.setattr("sys.argv", ["cost"])
    assert command.main() == command.UNUSABLE
    assert "--pin" in capsys.readouterr().err


@pytest.mark.parametrize("file", sorted(FOLDER.glob("*.json")), ids=lambda file: file.stem)
def test_every_scenario_is_pinned_and_nothing_else(file: Path) -> None:
    assert list(read(file)) == list(SCENARIOS)
