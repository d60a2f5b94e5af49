"""A process of `scale`: cells at work in one process, the plant's port joined directly to played robots.

It prints one line of JSON: reactions (s), tasks, seconds of processor time (of the process, and of the
plant's thread alone), the share of one core, own memory in bytes.
"""

from __future__ import annotations

import json
import sys
import threading
import time
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.plant_file.loader import load
from arboleda.runtime.build import App, Options, build
from arboleda.views.diagnostics import Diagnostic
from arboleda_ros import view_text

from .played import Crew
from .processes import own_memory

MOVES = 5  # in a task: to the start, over the path, to the pick-up, to the station, home
DWELL_S = 0.6
LIMIT_S = 30.0


class Topics:
    """The plant's port on ROS 2 without ROS 2: each view is written as JSON, commands go to the crew."""

    watched, diagnosed = True, False

    def __init__(self, crew: Crew) -> None:
        self.send = crew.send

    def check_alone(self) -> None:
        """Do nothing: there is no network, so no other plant."""

    def publish_view(self, snapshot: dict[str, Any]) -> Iterator[None]:
        yield from view_text.in_parts(snapshot)

    def publish_diagnostics(self, statuses: Iterable[Diagnostic]) -> Iterator[None]:
        yield from ()


class Customers:
    """Give every cell its next task as soon as it begins one, so that it always has one."""

    def __init__(self, app: App) -> None:
        self._app = app
        self._number = 0
        self._news = threading.Condition()
        self.ended = 0
        self.failed: list[str] = []

    def begin(self, cells: Sequence[str], over_s: float) -> None:
        """Have the cells begin one after the other, so that they do not go on in step."""
        for number, cell in enumerate(cells):
            time.sleep(over_s / len(cells) if number else 0.0)
            self._ask(cell)

    def take(self, change: TaskChanged) -> None:
        if change.state is TaskState.RUNNING and change.cell is not None:
            self._ask(change.cell)
        elif change.state is TaskState.DONE:
            with self._news:
                self.ended += 1
                self._news.notify()
        elif change.state is not TaskState.QUEUED:
            self.failed.append(f"{change.text}: {change.state.value} ({change.sentence})")

    def await_end(self) -> None:
        """Wait for the next task that ends."""
        with self._news:
            before = self.ended
            if not self._news.wait_for(lambda: self.ended > before, LIMIT_S) or self.failed:
                raise ArboledaError(f"a task did not end well: {self.failed or 'none ends'}")

    def _ask(self, cell: str) -> None:
        self._number += 1
        self._app.plant.submit(f"{cell} 0B {self._number % 9}")


def main(plant: str, state: str, move_s: str, seconds: str) -> None:
    model = load(Path(plant))
    app = build(model, {"orchestrator"}, Options(state_dir=Path(state)))
    orchestrator = app.orchestrator
    assert orchestrator is not None
    crew = Crew(model, orchestrator.hear, move_s=float(move_s))
    customers = Customers(app)
    topics = Topics(crew)
    orchestrator.connect_ros(topics)
    orchestrator.connect(topics)
    app.listen(customers.take)
    app.start()
    try:
        crew.start()
        customers.begin([cell.name for cell in model.cells], over_s=MOVES * float(move_s) + DWELL_S)
        print(json.dumps(_measured(crew, customers, float(seconds))), flush=True)
    finally:
        crew.stop()
        app.stop()


def _measured(crew: Crew, customers: Customers, seconds: float) -> dict[str, Any]:
    """The figures from one end of a task to another: with few cells a part of a task would count."""
    customers.await_end()
    crew.reactions.clear()
    before, ended, began = _clocks(), customers.ended, time.monotonic()
    time.sleep(seconds)
    customers.await_end()
    after, tasks, lasted = _clocks(), customers.ended - ended, time.monotonic() - began
    process, thread = (b - a for a, b in zip(before, after, strict=True))
    return {
        "reactions": list(crew.reactions),
        "tasks": tasks,
        "process_s": process,
        "plant_s": thread,
        "load": process / lasted,
        "memory": own_memory(),
    }


def _clocks() -> tuple[float, float]:
    """The processor times of this process and of the plant's thread."""
    plant = next(each for each in threading.enumerate() if each.name == "orchestrator")
    assert plant.ident is not None
    return time.process_time(), time.clock_gettime(time.pthread_getcpuclockid(plant.ident))


if __name__ == "__main__":
    main(*sys.argv[1:])
