"""Metrics of a plant for Prometheus: counts since its start, and its state at the moment of the request."""

from __future__ import annotations

from collections import Counter as Counted
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from prometheus_client import CollectorRegistry, Counter, Histogram, generate_latest
from prometheus_client.core import GaugeMetricFamily, InfoMetricFamily, Metric

from arboleda import __version__
from arboleda.adapters import clock
from arboleda.model.messages import ENDED, TaskChanged, TaskState
from arboleda.views.alarms import needs_in

WORK_S = (1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1800, 3600)
REACTION_S = (0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1)
COMMIT_S = (0.0002, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5)


class Metrics:
    """Metrics: counts in the plant's thread; other threads read them, which calls `snapshot` and `links`."""

    def __init__(self, snapshot: Callable[[], dict[str, Any]], links: Callable[[], dict[str, Any]]) -> None:
        self._snapshot = snapshot
        self._links = links
        self._waiting: set[str] = set()
        self._begun: dict[str, float] = {}
        self._boots: dict[str, Any] = {}
        self._online: set[str] = set()
        self._has_counts = False  # whether its cells and robots have their counts
        self._registry = registry = CollectorRegistry()
        self._accepted = Counter(
            "arboleda_tasks_accepted", "Tasks that a cell took.", ["cell"], registry=registry
        )
        self._ended = Counter(
            "arboleda_tasks_ended",
            "Tasks that ended, and why where they were not done.",
            ["cell", "outcome", "reason"],
            registry=registry,
        )
        self._worked = Histogram(
            "arboleda_task_seconds",
            "From the beginning of a task's work to its end.",
            ["cell", "outcome"],
            buckets=WORK_S,
            registry=registry,
        )
        self._reactions = Histogram(
            "arboleda_reaction_seconds",
            "From the last event of a step, a report say, to its commands being on their way.",
            buckets=REACTION_S,
            registry=registry,
        )
        self._commits = Histogram(
            "arboleda_commit_seconds",
            "How long the plant waited for its memory to be on the disk, or in the database.",
            buckets=COMMIT_S,
            registry=registry,
        )
        self._restarts = Counter(
            "arboleda_robot_restarts", "Boards that were seen to boot anew.", ["robot"], registry=registry
        )
        self._lost = Counter(
            "arboleda_robot_links_lost", "Links that were seen to break.", ["robot"], registry=registry
        )
        registry.register(_Now(self._now))

    def text(self) -> bytes:
        """All of it in the text format of Prometheus."""
        return bytes(generate_latest(self._registry))

    def changed(self, task: TaskChanged) -> None:
        """Count a task that was taken, begins or ends; repeated requests for a task do not count."""
        cell = task.cell or ""
        if task.state is TaskState.QUEUED and task.task not in self._waiting:
            self._waiting.add(task.task)
            self._accepted.labels(cell).inc()
        elif task.state is TaskState.RUNNING:
            self._begun.setdefault(task.task, clock.seconds())
        elif task.state in ENDED and task.request is None:
            self._waiting.discard(task.task)
            self._ended.labels(cell, task.state.value, task.reason.value if task.reason else "").inc()
            if (begun := self._begun.pop(task.task, None)) is not None:
                self._worked.labels(cell, task.state.value).observe(clock.seconds() - begun)

    def reacted(self, seconds: float) -> None:
        """Count the time that commands took to leave."""
        self._reactions.observe(seconds)

    def committed(self, seconds: float) -> None:
        """Count the time that a commit took."""
        self._commits.observe(seconds)

    def saw(self, snapshot: dict[str, Any]) -> None:
        """Count boots and lost links since the last snapshot."""
        if not self._has_counts:
            self._begin(snapshot)
        for robot in snapshot["robots"]:
            name, boot = robot["name"], robot["boot_id"]
            if boot is not None and self._boots.setdefault(name, boot) != boot:
                self._boots[name] = boot
                self._restarts.labels(name).inc()
            if robot["online"]:
                self._online.add(name)
            elif name in self._online:
                self._online.remove(name)
                self._lost.labels(name).inc()

    def _begin(self, snapshot: dict[str, Any]) -> None:
        """Set counts to 0 before anything happens, as Prometheus misses the step that begins a series."""
        self._has_counts = True
        for cell in snapshot["cells"]:
            self._accepted.labels(cell["name"])
            self._ended.labels(cell["name"], TaskState.DONE.value, "")
        for robot in snapshot["robots"]:
            self._restarts.labels(robot["name"])
            self._lost.labels(robot["name"])

    def _now(self) -> Iterator[Metric]:
        snapshot, links = self._snapshot(), self._links()
        plant = {"plant": snapshot["plant"], "version": __version__}
        yield InfoMetricFamily("arboleda", "The plant and the version that runs it.", plant)
        cells, robots, zones = snapshot["cells"], snapshot["robots"], snapshot["zones"]
        yield _rows(
            "arboleda_cell_state",
            "1 for the state that a cell is in.",
            ("cell", "state"),
            {(cell["name"], cell["state"]): 1 for cell in cells},
        )
        yield _rows(
            "arboleda_cell_needs_somebody",
            "1 for why a cell needs somebody: held, aborted, stopped, blocked or paused with tasks, asked.",
            ("cell", "why"),
            dict.fromkeys(needs_in(snapshot).items(), 1),
        )
        yield _rows(
            "arboleda_package_alarms",
            "Alarms that a package has raised, and that stand.",
            ("package", "level"),
            Counted((each["package"], each["level"]) for each in snapshot.get("alarms", ())),
        )
        yield _rows(
            "arboleda_cell_queue",
            "Tasks that wait.",
            ("cell",),
            {(cell["name"],): len(cell["queue"]) for cell in cells},
        )
        yield _rows(
            "arboleda_robot_online",
            "Whether a device is heard.",
            ("robot",),
            {(robot["name"],): robot["online"] for robot in robots},
        )
        yield _rows(
            "arboleda_robot_latched",
            "Whether a device is stopped by software.",
            ("robot",),
            {(robot["name"],): robot["latched"] for robot in robots},
        )
        yield _rows(
            "arboleda_zone_state",
            "1 for the state that a zone is in.",
            ("zone", "state"),
            {(zone["zone"], zone["state"]): 1 for zone in zones},
        )
        if (memory := links.get("memory")) is not None:
            yield _rows("arboleda_memory_slow", "Whether commits are slow now.", (), {(): memory["is_slow"]})
        if (broker := links["broker"]) is not None:
            yield _rows(
                "arboleda_broker_connected",
                "Whether the MQTT broker is there.",
                (),
                {(): broker["connected"]},
            )


class _Now:
    """The metrics that are collected anew for each request."""

    def __init__(self, collect: Callable[[], Iterator[Metric]]) -> None:
        self.collect = collect

    def describe(self) -> list[Metric]:
        """No metrics, so that nobody asks a plant that does not run yet."""
        return []


def _rows(
    name: str, about: str, labels: tuple[str, ...], values: Mapping[tuple[str, ...], float]
) -> GaugeMetricFamily:
    family = GaugeMetricFamily(name, about, labels=labels)
    for row, value in values.items():
        family.add_metric(row, float(value))
    return family
