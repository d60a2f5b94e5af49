"""The cost of keeping tasks: their acceptance, a restart, the page's history, and its pruning.

Acceptance: ours is the plant in its thread with its store on disk, from a request to its answer; the floor is
a thread that is asked in the same way, does one commit with synchronous=FULL of the same row to a table
without an index, and answers. The same without the threads, the commits alone, stands below. All have turns.

Restart: `arboleda up` with its virtual boards, from its start as a process until every robot is heard; the
floor is the same with an empty memory. First screen: the page's first request for its history of a plant
with a million tasks, over HTTP; the floor is that of a plant with ten. Pruning: the work of a step that ends
a task to forget old ones; the floor is the bare commit.
"""

from __future__ import annotations

import sqlite3
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from pathlib import Path
from queue import SimpleQueue
from statistics import median
from threading import Thread
from typing import Any

import httpx

from arboleda.model.messages import TaskChanged, TaskState
from arboleda.plant_file.loader import load
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.runtime.state import STORE, find_running
from arboleda.store import row_sums
from arboleda.store.sqlite import Store

from .processes import Process
from .result import Aim, Figure, Result, percentile
from .scene import Scene, wait_for

CELL, PLANT = "sis_a", "arboleda"
BARE = "CREATE TABLE task (id TEXT, text TEXT, cell TEXT, recipe TEXT, state TEXT, accepted_s REAL)"
INSERT = "INSERT INTO task VALUES (?, ?, ?, ?, ?, ?)"
PERCENTS, MEDIAN = (50, 99), (50,)
PAUSE_S = 0.005  # between two tasks: a log that is folded into its file meanwhile is folded for both
DAY_S = 86_400.0
UP = "from arboleda.cli.main import main; main()"
READY_S = 60.0
PAGE = "/?tab=tasks"  # what a browser asks for before
FIRST_SCREEN = "/history.json?words=&lang=en&limit=20"
SEARCH = "/history.json?words=no+such+task&lang=en&limit=20"


def run(scene: Scene) -> Result:
    tasks, starts, many = (100, 1, 20_000) if scene.quick else (1000, 7, 1_000_000)
    figures = _acceptance(scene, tasks)
    figures += _pruning(scene, tasks)
    figures += _restart(scene, starts)
    figures += _screens(scene, many)
    return Result(
        figures=figures,
        notes=(
            f"{tasks} tasks accepted and as many bare commits, {starts} starts of each kind, in turns.",
            f"First screen and search: {many:,} tasks in the history.",
            "Where a bare commit takes a tenth of a millisecond, what the plant does besides it shows.",
        ),
    )


class Bare:
    """A thread that commits what it is asked to, and answers."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._inbox: SimpleQueue[tuple[tuple[Any, ...], Future[None]] | None] = SimpleQueue()
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    def ask(self, row: tuple[Any, ...]) -> Future[None]:
        answer: Future[None] = Future()
        self._inbox.put((row, answer))
        return answer

    def end(self) -> None:
        self._inbox.put(None)
        self._thread.join()

    def _run(self) -> None:
        db = bare(self._file)
        while (asked := self._inbox.get()) is not None:
            row, answer = asked
            db.execute(INSERT, row)
            answer.set_result(None)
        db.close()


class Deaf:
    """A port to robots of which none is there."""

    def send(self, message: object) -> None: ...


def bare(file: Path) -> sqlite3.Connection:
    """A database like the store's, with nothing in it but a table."""
    db = sqlite3.connect(file, isolation_level=None)
    db.execute("PRAGMA journal_mode = WAL")
    db.execute("PRAGMA synchronous = FULL")
    db.execute(BARE)
    return db


def _acceptance(scene: Scene, tasks: int) -> list[Figure]:
    scene.say(f"acceptance of {tasks} tasks")
    model = load(None)
    model = replace(model, cells=tuple(replace(cell, queue_limit=tasks) for cell in model.cells))
    alone = bare(scene.folder / "alone.sqlite")
    floor = Bare(scene.folder / "bare.sqlite")
    with Store(scene.folder / "ours.sqlite") as store, Store(scene.folder / "store.sqlite") as only:
        plant = Orchestrator(model, 1, _raise, store)
        plant.connect(Deaf())
        plant.keeping.durability.start()
        plant.loop.start()
        times: list[list[float]] = [[], [], [], []]
        for number in range(tasks):
            text = f"{CELL} 0B {number % 9}"
            row = (f"lot{number}", text, CELL, "storage", "queued", time.time())
            queued = TaskChanged(task=f"lot{number}", text=text, cell=CELL, state=TaskState.QUEUED)
            deeds: Sequence[Callable[[], object]] = (
                partial(_result, plant.submit, f"{text} #{row[0]}"),
                partial(_result, floor.ask, row),
                partial(only.tasks.keep, queued, "storage", 1.0),
                partial(alone.execute, INSERT, row),
            )
            for deed, known in zip(deeds, times, strict=True):
                known.append(_seconds(deed))
                time.sleep(PAUSE_S)
        plant.loop.stop()
        plant.keeping.durability.stop()
    floor.end()
    alone.close()
    asked, bare_asked, commits, bare_commits = times
    return [
        *_both("acceptance", asked, bare_asked, Aim(most=3), MEDIAN),  # the slowest waits for the disk
        *_both("commit alone", commits, bare_commits, Aim(most=1.3)),
    ]


def _pruning(scene: Scene, tasks: int) -> list[Figure]:
    scene.say("pruning")
    file = scene.folder / "pruned.sqlite"
    fill(file, ended=50 * tasks, queued=0)
    alone = bare(scene.folder / "beside.sqlite")
    row = ("lot", f"{CELL} 0B 1", CELL, "storage", "queued", time.time())
    pruned, commits = [], []
    with Store(file) as store:
        for _ in range(tasks):
            pruned.append(_seconds(partial(store.tasks.forget, time.time())))
            commits.append(_seconds(partial(alone.execute, INSERT, row)))
            time.sleep(PAUSE_S)
    alone.close()
    return _both("pruning, in a step that ends a task", pruned, commits)


def _restart(scene: Scene, starts: int) -> list[Figure]:
    full, empty = scene.folder / "full", scene.folder / "empty"
    fill(full / STORE, ended=10_000, queued=500)
    times: dict[Path, list[float]] = {full: [], empty: []}
    for number in range(starts):
        scene.say(f"start {number + 1} of {starts}")
        for state in (full, empty):
            began = time.monotonic()
            plant = _started(scene, state)
            times[state].append(time.monotonic() - began)
            plant.end()
    ours, floor = median(times[full]), median(times[empty])
    return [
        Figure(name="start with 10,000 ended tasks, 500 queued", unit="s", ours=ours, floor=floor),
        Figure(
            name="so much later than with none", unit="s", ours=ours - floor, aim=Aim(most=1, of_ratio=False)
        ),
    ]


def _screens(scene: Scene, many: int) -> list[Figure]:
    scene.say(f"a history of {many:,} tasks")
    times: dict[tuple[str, str], list[float]] = {}
    for name, ended in (("many", many), ("few", 10)):
        state = scene.folder / name
        fill(state / STORE, ended=ended, queued=0)
        plant = _started(scene, state)
        running = find_running(state)
        assert running is not None
        with httpx.Client(base_url=running.url, trust_env=False, timeout=READY_S) as client:
            _get(client, PAGE)
            for path in (FIRST_SCREEN, SEARCH):
                known = times[name, path] = []
                for _ in range(20 if scene.quick else 100):
                    known.append(_seconds(partial(_get, client, path)))
                    time.sleep(PAUSE_S)
        plant.end()
    aim = Aim(most=200, of_ratio=False)
    screen, few = times["many", FIRST_SCREEN], times["few", FIRST_SCREEN]
    return [
        Figure(
            name="first screen, the first time", unit="ms", ours=1e3 * screen[0], floor=1e3 * few[0], aim=aim
        ),
        *_both("first screen", screen, few, aim),
        *_both("search that finds nothing", times["many", SEARCH], times["few", SEARCH]),
    ]


def fill(file: Path, *, ended: int, queued: int) -> None:
    """A plant's memory with tasks of the last 80 days."""
    file.parent.mkdir(exist_ok=True)
    with Store(file, PLANT):
        pass
    now = time.time()
    db = sqlite3.connect(file)
    row_sums.know(db)
    row_sums.watch(db)
    with db:
        db.executemany(
            "INSERT INTO task (id, text, cell, recipe, state, accepted_s, started_s, ended_s)"
            " VALUES (?, ?, ?, 'storage', 'done', ?, ?, ?)",
            (
                (f"lot{n}", f"{CELL} 0B {n % 9}", CELL, at, at + 1, at + 9)
                for n in range(ended)
                for at in [now - 80 * DAY_S * (1 - n / ended)]
            ),
        )
        db.executemany(
            "INSERT INTO task (id, text, cell, recipe, state, accepted_s)"
            " VALUES (?, ?, ?, 'storage', 'queued', ?)",
            (
                (f"next{n}", f"{cell} 0B {n % 9}", cell, now)
                for n in range(queued)
                for cell in [f"sis_{'abc'[n % 3]}"]
            ),
        )
    db.close()


def _started(scene: Scene, state: Path) -> Process:
    """A started plant, once all its robots are there."""
    log = state.with_name(f"{state.name}_{len(list(scene.folder.glob('*.log')))}.log")
    process = Process([sys.executable, "-c", UP, "up", "--no-ros", "--state", str(state)], log)
    try:
        wait_for(lambda: _all_heard(state), "arboleda up", process.check, READY_S)
    except BaseException:  # Ctrl-C too
        process.end()
        raise
    return process


def _all_heard(state: Path) -> bool:
    running = find_running(state)
    if running is None or running.port is None:
        return False
    snapshot = httpx.get(f"{running.url}/api/plant", trust_env=False, timeout=READY_S).json()
    return all(robot["online"] for robot in snapshot["robots"])


def _get(client: httpx.Client, path: str) -> None:
    client.get(path).raise_for_status()


def _both(
    name: str,
    ours: Sequence[float],
    floor: Sequence[float],
    aim: Aim | None = None,
    held: Sequence[int] = PERCENTS,
) -> list[Figure]:
    return [
        Figure(
            name=f"{name}, p{percent}",
            unit="ms",
            ours=1e3 * percentile(ours, percent),
            floor=1e3 * percentile(floor, percent),
            aim=aim if percent in held else None,
        )
        for percent in PERCENTS
    ]


def _seconds(deed: Callable[[], object]) -> float:
    began = time.perf_counter()
    deed()
    return time.perf_counter() - began


def _raise(_name: str, error: BaseException) -> None:
    raise error


def _result(ask: Callable[[Any], Any], what: object) -> object:
    return ask(what).result()
