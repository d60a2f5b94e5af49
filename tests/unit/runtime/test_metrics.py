"""What Prometheus is told of a plant."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from prometheus_client.parser import text_string_to_metric_families

from arboleda.adapters import clock
from arboleda.core.plant import Plant
from arboleda.model.messages import Reason, TaskChanged, TaskState
from arboleda.runtime.parts.metrics import Metrics
from arboleda.testing import shipped
from arboleda.views import view

Read = Callable[..., "float | None"]
LINKS = {
    "broker": {"address": "127.0.0.1:1883", "connected": True},
    "memory": {"typical_s": 0.35, "worst_s": 0.4, "is_slow": True},
}


@pytest.fixture
def snapshot() -> dict[str, Any]:
    return view.snapshot(Plant(shipped("sis_a"), epoch=1, now=0.0))


@pytest.fixture
def metrics(snapshot: dict[str, Any]) -> Metrics:
    return Metrics(lambda: snapshot, lambda: LINKS)


@pytest.fixture
def read(metrics: Metrics) -> Read:
    """The value of a metric with these labels, None where there is none."""

    def value(name: str, **labels: str) -> float | None:
        families = text_string_to_metric_families(metrics.text().decode())
        samples = (sample for family in families for sample in family.samples)
        return next((each.value for each in samples if (each.name, each.labels) == (name, labels)), None)

    return value


def task(state: TaskState, reason: Reason | None = None) -> TaskChanged:
    return TaskChanged(task="t1", text="sis_a 0B 7", cell="sis_a", state=state, reason=reason)


def test_a_cell_that_needs_somebody_says_why(snapshot: dict[str, Any], metrics: Metrics, read: Read) -> None:
    cell = snapshot["cells"][0]
    needs = "arboleda_cell_needs_somebody"
    assert read(needs, cell="sis_a", why="blocked") is None, "no task waits"
    cell["queue"] = ["t1"]
    assert read(needs, cell="sis_a", why="blocked") == 1
    cell |= {"state": "held"}
    assert read(needs, cell="sis_a", why="held") == 1 and read(needs, cell="sis_a", why="blocked") is None


def test_tasks_are_counted_by_cell_outcome_and_reason(metrics: Metrics, read: Read) -> None:
    for change in (task(TaskState.QUEUED), task(TaskState.FAILED, Reason.LINK_LOST), task(TaskState.DONE)):
        metrics.changed(change)
    assert read("arboleda_tasks_accepted_total", cell="sis_a") == 1
    ended = {"cell": "sis_a", "outcome": "failed", "reason": "link_lost"}
    assert read("arboleda_tasks_ended_total", **ended) == 1
    assert read("arboleda_tasks_ended_total", cell="sis_a", outcome="done", reason="") == 1


def test_counts_stand_at_zero_before_anything_happens(
    metrics: Metrics, read: Read, snapshot: dict[str, Any]
) -> None:
    metrics.saw(snapshot)
    assert read("arboleda_tasks_accepted_total", cell="sis_a") == 0
    assert read("arboleda_tasks_ended_total", cell="sis_a", outcome="done", reason="") == 0
    assert read("arboleda_robot_restarts_total", robot="ra1") == 0
    assert read("arboleda_robot_links_lost_total", robot="ra1") == 0


def test_who_asks_for_a_task_again_is_not_counted_again(metrics: Metrics, read: Read) -> None:
    asked = {"request": "r1"}
    for state, by in (
        (TaskState.QUEUED, asked),
        (TaskState.QUEUED, asked),
        (TaskState.RUNNING, {}),
        (TaskState.RUNNING, asked),
        (TaskState.DONE, {}),
        (TaskState.DONE, asked),
    ):
        metrics.changed(replace(task(state), **by))
    assert read("arboleda_tasks_accepted_total", cell="sis_a") == 1
    assert read("arboleda_tasks_ended_total", cell="sis_a", outcome="done", reason="") == 1
    assert read("arboleda_task_seconds_count", cell="sis_a", outcome="done") == 1


def test_a_task_took_as_long_as_it_was_worked_on(
    metrics: Metrics, read: Read, monkeypatch: pytest.MonkeyPatch
) -> None:
    for now, state in enumerate((TaskState.QUEUED, TaskState.RUNNING, TaskState.RUNNING, TaskState.DONE)):
        monkeypatch.setattr(clock, "seconds", lambda now=now: 10.0 * now)
        metrics.changed(task(state))
    assert read("arboleda_task_seconds_sum", cell="sis_a", outcome="done") == 20.0
    assert read("arboleda_task_seconds_count", cell="sis_a", outcome="done") == 1


def test_boots_and_lost_links_are_counted_once(
    metrics: Metrics, read: Read, snapshot: dict[str, Any]
) -> None:
    robot = snapshot["robots"][0]
    name = robot["name"]
    for online, boot in ((True, 7), (True, 7), (False, 7), (False, 7), (True, 8), (True, 8)):
        robot |= {"online": online, "boot_id": boot}
        metrics.saw(snapshot)
    assert read("arboleda_robot_restarts_total", robot=name) == 1
    assert read("arboleda_robot_links_lost_total", robot=name) == 1


def test_how_things_stand_is_asked_for_each_time(read: Read, snapshot: dict[str, Any]) -> None:
    cell = snapshot["cells"][0]
    assert read("arboleda_cell_state", cell="sis_a", state=cell["state"]) == 1
    assert read("arboleda_robot_online", robot="ra1") == 0
    assert read("arboleda_broker_connected") == 1
    cell["state"], snapshot["robots"][0]["online"] = "execute", True
    assert read("arboleda_cell_state", cell="sis_a", state="execute") == 1
    assert read("arboleda_robot_online", robot=snapshot["robots"][0]["name"]) == 1


def test_a_reaction_falls_into_its_bucket(metrics: Metrics, read: Read) -> None:
    metrics.reacted(0.003)
    assert read("arboleda_reaction_seconds_bucket", le="0.002") == 0
    assert read("arboleda_reaction_seconds_bucket", le="0.005") == 1


def test_commits_are_counted_and_said_to_be_slow(metrics: Metrics, read: Read) -> None:
    metrics.committed(0.35)
    assert read("arboleda_commit_seconds_bucket", le="0.2") == 0
    assert read("arboleda_commit_seconds_bucket", le="0.5") == 1
    assert read("arboleda_memory_slow") == 1


DOCS = Path(__file__).parents[3] / "docs" / "how-to"
NAMED = re.compile(r"\barboleda_\w+")
LABELS = re.compile(r'(\w+) ?(?:=~|!~|!=|=) ?"|by \(([^)]*)\)')
OF_PROMETHEUS = {"le", "job"}


def board() -> dict[str, Any]:
    return json.loads((DOCS / "grafana.json").read_text())


def expressions(place: str) -> list[str]:
    """What is asked of Prometheus there."""
    if place == "grafana.json":
        asked = [target["expr"] for panel in board()["panels"] for target in panel["targets"]]
        return [
            *asked,
            *(each["definition"] for each in board()["templating"]["list"] if "definition" in each),
        ]
    text = (DOCS / "watch.md").read_text()
    rules = [line.partition("expr:")[2] for line in text.splitlines() if "expr:" in line]
    return rules + re.findall(r"\| `([^`]*\([^`]*)` \|", text)


@pytest.fixture
def told(metrics: Metrics, snapshot: dict[str, Any]) -> dict[str, set[str]]:
    """The labels of each metric of a plant to which everything that is counted has happened."""
    for state in (TaskState.QUEUED, TaskState.RUNNING, TaskState.DONE):
        metrics.changed(task(state))
    metrics.reacted(0.001)
    snapshot["cells"][0]["queue"] = ["t1"]
    robot = snapshot["robots"][0]
    for boot, online in ((1, True), (2, True), (2, False)):
        metrics.saw(snapshot | {"robots": [robot | {"boot_id": boot, "online": online}]})
    families = text_string_to_metric_families(metrics.text().decode())
    found: dict[str, set[str]] = {}
    for sample in (sample for family in families for sample in family.samples):
        found.setdefault(sample.name, set()).update(sample.labels)
    return found


@pytest.mark.parametrize(("place", "least"), [("grafana.json", 15), ("watch.md", 10)])
def test_each_metric_and_label_that_is_asked_for_exists(
    told: dict[str, set[str]], place: str, least: int
) -> None:
    asked = expressions(place)
    assert len(asked) >= least
    for expression in asked:
        names = set(NAMED.findall(expression))
        assert names <= told.keys(), expression
        known = OF_PROMETHEUS.union(*(told[name] for name in names))
        groups = [one or many for one, many in LABELS.findall(expression)]
        labels = {label.strip() for group in groups for label in group.split(",")}
        assert labels <= known, expression


def test_the_panels_of_the_dashboard_have_a_place_and_a_number_of_their_own() -> None:
    panels = board()["panels"]
    assert len({panel["id"] for panel in panels}) == len(panels)
    fields = [
        (x, y)
        for at in (panel["gridPos"] for panel in panels)
        for x in range(at["x"], at["x"] + at["w"])
        for y in range(at["y"], at["y"] + at["h"])
    ]
    assert len(set(fields)) == len(fields) and max(x for x, _ in fields) < 24
