"""The OEE of a plant: what is kept of its cells while it runs, and the figures that come of it."""

from __future__ import annotations

import json
import sqlite3
from datetime import datetime
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.adapters.clock import Calendar
from arboleda.cli.main import cli
from arboleda.model.cell_states import CellState
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import TaskChanged, TaskState, Verb
from arboleda.oee.figures import SEEN_S, Oee
from arboleda.rig.rig import Rig
from arboleda.runtime.build import Options, build
from arboleda.runtime.state import STORE
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import TaskHistory, TaskQuery
from arboleda.store.time_table import TimeTable
from arboleda.testing import shipped
from arboleda_fleet.oee.api import OeeApi, OeeQuery
from arboleda_fleet.oee.cell_times import CellTimes
from arboleda_fleet.oee.rows import figures

BEGAN = 1_000_000.0  # Unix time of the rig's first second


@pytest.fixture
def store(tmp_path: Path) -> Store:
    kept = Store(tmp_path / STORE)
    kept.open()
    return kept


@pytest.fixture
def rig(store: Store) -> Rig:
    """A plant at work whose every step is kept as the orchestrator keeps it."""
    rig = Rig(shipped("sis_a"), now=0.0)
    times = CellTimes(store.times, lambda: BEGAN + rig.now)
    times.start()

    def keep() -> None:
        for message in rig.moment.sent:
            if isinstance(message, TaskChanged):
                store.tasks.keep(message, "storage", BEGAN + rig.now)
        times.stepped(rig.plant)

    rig.watchers.append(keep)
    rig.times = times  # type: ignore[attr-defined]
    return rig


def test_a_clock_that_is_set_while_tasks_run_takes_none_from_the_figures(tmp_path: Path) -> None:
    rig, clocks = Rig(shipped("sis_a"), now=0.0), {"ahead_s": BEGAN}
    calendar = Calendar(lambda: rig.now + clocks["ahead_s"], lambda: rig.now)
    with Store(tmp_path / STORE) as store:
        times = CellTimes(store.times, calendar.unix_s)
        times.start()

        def keep() -> None:
            for message in rig.moment.sent:
                if isinstance(message, TaskChanged):
                    store.tasks.keep(message, "storage", calendar.unix_s(), ran_s=rig.now)
            times.stepped(rig.plant)
            if by_s := calendar.look():
                store.move_times(by_s, calendar.unix_s(), 0.0, rig.now)

        rig.watchers.append(keep)
        for task, ahead_s in zip("abcd", (86_400.0, 0.0, -86_400.0, 0.0), strict=True):
            rig.submit(f"sis_a 0B 7 #{task}")
            rig.wait(0.7)
            clocks["ahead_s"] = BEGAN + ahead_s
            assert rig.wait(600.0, lambda task=task: rig.outcomes()[task].state is TaskState.DONE)  # type: ignore[misc]
            rig.wait(1.0)
        found = of_cell(store, rig)
        took = [row.ended_s - row.started_s for row in store.tasks.select(TaskQuery())]
    assert found.done == found.timed == 4 and max(took) < 60.0
    assert found.performance == pytest.approx(4 * min(took) / sum(took), rel=1e-6)
    assert found.availability == pytest.approx(1.0)


def of_cell(store: Store, rig: Rig) -> Oee:
    query = OeeQuery(since_s=BEGAN, until_s=BEGAN + rig.now)
    (found,) = figures(TaskHistory(store.path), query, BEGAN + rig.now, ["sis_a"])
    return found


def done(rig: Rig, task: str) -> None:
    rig.submit(f"sis_a 0B 7 #{task}")
    assert rig.wait(600.0, lambda: rig.outcomes()[task].state is TaskState.DONE)
    rig.wait(1.0)


def test_performance_is_the_shortest_of_the_times_that_the_history_has_to_all_of_them(
    rig: Rig, store: Store
) -> None:
    for task in "abc":
        done(rig, task)
    found = of_cell(store, rig)
    took = [row.ended_s - row.started_s for row in store.tasks.select(TaskQuery())]
    assert found.done == found.timed == len(took) == 3
    assert found.performance == pytest.approx(3 * min(took) / sum(took), rel=1e-6)
    assert found.availability == pytest.approx(1.0) and found.quality == 1.0
    assert found.oee == pytest.approx(found.availability * found.performance * found.quality)


@pytest.mark.long
def test_a_hold_is_down_time_and_no_slow_work(rig: Rig, store: Store) -> None:
    for task in "abc":
        done(rig, task)
    before = of_cell(store, rig)
    rig.submit("sis_a 0B 7 #d")
    rig.wait(5.0)
    rig.operate(Verb.HOLD, "sis_a")
    assert rig.wait(30.0, lambda: rig.plant.cells["sis_a"].state is CellState.HELD)
    rig.wait(1000.0)
    rig.operate(Verb.RESUME, "sis_a")
    assert rig.wait(600.0, lambda: rig.outcomes()["d"].state is TaskState.DONE)
    found = of_cell(store, rig)
    assert found.planned_s - found.worked_s == pytest.approx(1000.0, abs=10.0)
    assert found.performance == pytest.approx(before.performance, abs=0.1)


def test_that_a_plant_runs_is_kept_each_minute_and_that_it_was_ended(rig: Rig, store: Store) -> None:
    rig.wait(10 * SEEN_S)
    runs = sqlite3.connect(store.path)
    since, seen, ended = runs.execute("SELECT since_s, seen_s, ended FROM run").fetchone()
    assert since == BEGAN and BEGAN + 9 * SEEN_S <= seen <= BEGAN + rig.now and not ended
    rig.times.stop()
    assert runs.execute("SELECT seen_s, ended FROM run").fetchall() == [(BEGAN + rig.now, 1)]


class Full(TimeTable):
    """A table on a disk without room."""

    def stands(self, cell: str, state: str | None, unix_s: float) -> None:
        raise ArboledaError("no room on the disk")


def test_figures_that_cannot_be_kept_are_said_once_and_end_no_plant(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    rig = Rig(shipped("sis_a"))
    with Store(tmp_path / "full.sqlite") as store:
        times = CellTimes(Full(store), lambda: BEGAN + rig.now)
        times.start()
        rig.watchers.append(lambda: times.stepped(rig.plant))
        rig.operate(Verb.STOP)
        rig.wait(60.0)
        times.stop()
    assert [line.message for line in caplog.records] == [
        "the times of cells are not kept any more, `arboleda oee` lacks them: no room on the disk"
    ]


def test_the_command_and_a_plant_that_runs_say_the_same(rig: Rig, store: Store, tmp_path: Path) -> None:
    for task in "abc":
        done(rig, task)
    store.close()
    app = build(shipped("sis_a"), {"orchestrator"}, Options(state_dir=tmp_path, page=False))
    (running,) = app.offers.need(OeeApi).oee(OeeQuery(since_s=BEGAN, until_s=BEGAN + rig.now))
    app.stop()
    said = json.loads(typed(tmp_path, "--since", when(BEGAN), "--until", when(BEGAN + rig.now), "--json"))
    known = running.data()
    assert said.keys() == known.keys() and said["cell"] == "sis_a" and said["done"] == 3
    numbers = [name for name, value in known.items() if isinstance(value, float)]
    assert [said[name] for name in numbers] == pytest.approx([known[name] for name in numbers], rel=1e-6)


def test_the_command_shows_a_table_and_why_there_is_no_figure(rig: Rig, store: Store, tmp_path: Path) -> None:
    done(rig, "a")
    store.close()
    shown = " ".join(typed(tmp_path, "--since", when(BEGAN)).split())
    assert "sis_a - " in shown and "0 of 1 tasks can be compared" in shown and "100 %" in shown


def test_of_a_plant_that_kept_nothing_the_command_says_so(tmp_path: Path) -> None:
    assert "no cell had a task in that time" in typed(tmp_path)


def when(unix_s: float) -> str:
    return datetime.fromtimestamp(unix_s).isoformat()


def typed(state: Path, *args: str) -> str:
    outcome = CliRunner().invoke(
        cli, ["oee", *args, "--state", str(state)], catch_exceptions=False, env={"COLUMNS": "200"}
    )
    assert outcome.exit_code == 0, outcome.output
    return outcome.output
