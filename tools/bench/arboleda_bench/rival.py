"""Arboleda beside event-driven trees of py_trees and BehaviorTree.CPP: from a step's end to the next command.

All have the same recipe (`steps.storage`) and speak the same lines over their standard input and output, so
that no middleware is measured: `task` and `done` in, `do KIND` and `end` out. A reaction is the time from
before `done` is written, after a drive or a move, to the receipt of the next `do`; each step lasts 30 to 60
ms, in which every process sleeps, as beside real robots. Those after an effector are left out, as Arboleda's
recipe waits there.

Arboleda (`rival_arboleda.py`) is the part `orchestrator`: its plant, its loop, its memory on disk, robots
that report ten times a second. py_trees (`rival_py_trees.py`) ticks its tree in the thread that reads, once
for each line. BehaviorTree.CPP (`tools/bench/rival/event_tree.cpp`) is woken by `emitWakeUpSignal` from the
thread that reads. The floor (`rival_floor.py`) is a list of the same commands. These three check nothing,
keep nothing and watch no deadline. The program of BehaviorTree.CPP is built by `tools/bench/rival/measure`,
and left out without it.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

from . import plants, steps
from .processes import Process
from .result import Figure, Result, percentile
from .scene import Scene

PROGRAM = "ARBOLEDA_RIVAL"  # environment variable: the program that tools/bench/rival/measure has built
PAUSE_S = 0.01
SHORTEST_S, LONGEST_S = 0.03, 0.06
COUNTED = frozenset({"drive", "move"})  # after an effector the recipe waits
ABSENT = f"BehaviorTree.CPP was left out: {PROGRAM} names no program; tools/bench/rival/measure builds it."


def run(scene: Scene) -> Result:
    """All sides in turns."""
    turns, cycles = (2, 4) if scene.quick else (10, 12)
    sides = _sides(scene)
    move_s = steps.lengths(SHORTEST_S, LONGEST_S)
    found: dict[str, list[float]] = {name: [] for name in sides}
    for process in sides.values():
        cycle(process, move_s)  # until everything was used once
    for turn in range(turns):
        scene.say(f"turn {turn + 1} of {turns}")
        for name, process in sides.items():
            for _ in range(cycles):
                found[name] += cycle(process, move_s)
    return Result(figures=_figures(found), notes=_notes(found))


def cycle(process: Process, move_s: Callable[[], float]) -> list[float]:
    """One task of a side; its reactions, in ms."""
    found: list[float] = []
    ended: float | None = None
    process.write("task")
    while (line := process.read()) != "end":
        heard = time.perf_counter()
        if ended is not None:
            found.append(1e3 * (heard - ended))
        time.sleep(move_s())
        counts = line.removeprefix("do ") in COUNTED
        ended = time.perf_counter() if counts else None
        process.write("done")
    return found


def _sides(scene: Scene) -> dict[str, Process]:
    timing = {"dwell_s": PAUSE_S, "effector_settle_s": PAUSE_S}
    plant = plants.write(scene.folder / "plant.yaml", 1, timing=timing, near=True)
    sides = {
        "floor": scene.python("arboleda_bench.rival_floor", str(plant)),
        "Arboleda": scene.python("arboleda_bench.rival_arboleda", str(plant), str(scene.folder / "state")),
        "py_trees": scene.python("arboleda_bench.rival_py_trees", str(plant)),
    }
    program = os.environ.get(PROGRAM)
    if program:
        sides["BehaviorTree.CPP"] = scene.program(Path(program))
    return sides


def _figures(found: dict[str, list[float]]) -> list[Figure]:
    return [
        Figure(
            name=f"p{percent}, {name}",
            unit="ms",
            ours=percentile(reactions, percent),
            floor=percentile(found["floor"], percent),
        )
        for percent in (50, 99)
        for name, reactions in found.items()
        if name != "floor"
    ]


def _notes(found: dict[str, list[float]]) -> list[str]:
    counts = ", ".join(f"{len(reactions)} of {name}" for name, reactions in found.items())
    note = f"Reactions over pipes, in turns: {counts}. The floor is a list of commands in Python."
    return [note] if "BehaviorTree.CPP" in found else [note, ABSENT]
