"""A stop over HTTP while browsers crowd: 25 pages at once, again and again, streams, and views.

Ours is `POST /api/plant/stop` over a connection of its own, from before it is opened until its answer is
read, while `crowd` asks the same server for all of that. The floor is the same stop of the same plant before
the crowd comes. The state is on a disk of memory where there is one: how long a latch takes to be kept is
measured by `kept`.
"""

from __future__ import annotations

import http.client
import random
import shutil
import sys
import tempfile
import time
from contextlib import closing
from pathlib import Path

from arboleda.extension import ArboledaError

from . import plants
from .processes import Process
from .result import Aim, Figure, Result, percentile
from .scene import Scene, free_port, wait_for

CELLS = (6, 100)
SECONDS, QUICK_SECONDS = 20.0, 5.0
BETWEEN_S = (0.02, 0.08)
READY_S = 60.0
MEMORY = Path("/dev/shm")
MOST_MS = 150.0  # with few cells
UP = "from arboleda.cli.main import main; main()"


def run(scene: Scene) -> Result:
    figures: list[Figure] = []
    notes: list[str] = []
    folder = Path(tempfile.mkdtemp(prefix="arboleda_bench_", dir=MEMORY if MEMORY.is_dir() else None))
    try:
        for cells in CELLS:
            scene.say(f"{cells} cells")
            found, note = _measured(scene, folder, cells)
            figures += found
            notes.append(note)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return Result(figures=figures, notes=notes)


def _measured(scene: Scene, folder: Path, cells: int) -> tuple[list[Figure], str]:
    """The figures of a plant of so many cells, and the amount that the crowd was given meanwhile."""
    file, port = plants.write(scene.folder / f"plant_{cells}.yaml", cells), free_port()
    state = folder / f"state_{cells}"
    options = ("--no-ros", "--plant", str(file), "--state", str(state), "--port", str(port))
    plant = Process([sys.executable, "-c", UP, "up", *options], scene.folder / f"up_{cells}.log")
    try:
        wait_for(lambda: _answers(port), "arboleda up", plant.check, READY_S)
        floor = _stops(port, scene)
        crowd = scene.python("arboleda_bench.crowd", str(port))
        crowd.read()
        before = _done(crowd)
        ours = _stops(port, scene)
        pages, views = (now - then for now, then in zip(_done(crowd), before, strict=True))
        scene.end()
    finally:
        plant.end()
    aim = Aim(most=MOST_MS, of_ratio=False)
    figures = [
        Figure(
            name=f"{cells} cells, p{percent}",
            unit="ms",
            ours=percentile(ours, percent),
            floor=percentile(floor, percent),
            aim=aim if percent == 99 and cells == min(CELLS) else None,
        )
        for percent in (50, 99)
    ]
    return figures, f"{cells} cells: {len(ours)} stops, {pages} pages and {views} views meanwhile."


TAKEN = (http.client.OK, http.client.ACCEPTED)  # the latter for a stop that has left and is not kept yet


def _stops(port: int, scene: Scene) -> list[float]:
    """The milliseconds of each of the stops of one window."""
    until = time.monotonic() + (QUICK_SECONDS if scene.quick else SECONDS)
    taken = []
    while time.monotonic() < until:
        began = time.perf_counter()
        _ask(port, "POST", "/api/plant/stop")
        taken.append(1e3 * (time.perf_counter() - began))
        time.sleep(random.uniform(*BETWEEN_S))
    return taken


def _ask(port: int, method: str, path: str) -> None:
    with closing(http.client.HTTPConnection("127.0.0.1", port, timeout=READY_S)) as client:
        client.request(method, path)
        answer = client.getresponse()
        answer.read()
        if answer.status not in TAKEN:
            raise ArboledaError(f"{method} {path} was answered with {answer.status}")


def _answers(port: int) -> bool:
    try:
        _ask(port, "GET", "/api/plant")
    except (OSError, ArboledaError):
        return False
    return True


def _done(crowd: Process) -> tuple[int, int]:
    crowd.write("")
    pages, views = crowd.read().split()
    return int(pages), int(views)
