"""Many cells at work at once: how soon each is served, what a task costs, what a cell keeps in memory.

Ours is the part `orchestrator` as `build` makes it, plant, loop and store, in one process, its port joined
directly to robots that answer (`played.py`); every snapshot is written as JSON, row by row, as for
`/plant/view`. Every cell always has a task, its moves take a fixed time, every robot reports ten times a
second: each cell offers the same load whatever their number. The floor is the same with one cell. A reaction
is the time from the post of a report that ends a move to the next command of that cell, where no dwell stands
between.

Over ROS 2 the robots are played by this process, through the topics of the shipped bridge, and the plant is
the shipped node `orchestrator`. A reaction is then the time from before the publication of the report to the
receipt of the command. The start lasts from the node's start as a process until every robot hears the plant,
and until every cell has begun a task that was asked for then.
"""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from . import plants
from .crew_ros import CrewOnRos
from .result import Aim, Figure, Result, percentile
from .scene import Scene

MOVE_S, QUICK_MOVE_S = 0.8, 0.2
SIZES, QUICK_SIZES = (1, 10, 100, 300), (1, 100)
ROS_SIZES, QUICK_ROS_SIZES = (1, 10, 100), (1, 10)
ONE_S, MANY_S, QUICK_S = 15.0, 8.0, 2.0  # one cell ends few moves in a second
ROS_S = 6.0
MEASURED = 100  # cells at which the reaction has an aim
AIMS = {50: 2.0, 99: 10.0}  # by percentile, as ratio to one cell
START_S = 6.0
MB = 1e6


def run(scene: Scene) -> Result:
    sizes = QUICK_SIZES if scene.quick else SIZES
    joined = {size: _joined(scene, size) for size in sizes}
    figures = _reactions(joined) + _costs(joined)
    over_ros = {size: _over_ros(scene, size) for size in (QUICK_ROS_SIZES if scene.quick else ROS_SIZES)}
    figures += _reactions_over_ros(over_ros) + _starts(over_ros)
    return Result(figures=figures, notes=_notes(scene, joined))


def _joined(scene: Scene, size: int) -> dict[str, Any]:
    """The measurements of `busy` with so many cells."""
    scene.say(f"{size} cells in one process")
    seconds = QUICK_S if scene.quick else ONE_S if size == 1 else MANY_S
    file = plants.write(scene.folder / f"plant_{size}.yaml", size)
    state = scene.folder / f"state_{size}"
    busy = scene.python("arboleda_bench.busy", str(file), str(state), str(_move_s(scene)), str(seconds))
    measured: dict[str, Any] = json.loads(busy.read())
    scene.end()
    return measured


def _reactions(joined: dict[int, dict[str, Any]]) -> list[Figure]:
    one = joined[1]["reactions"]
    return [
        Figure(
            name=f"reaction p{percent}, {_cells(size)}",
            unit="ms",
            ours=percentile(found["reactions"], percent) * 1e3,
            floor=percentile(one, percent) * 1e3 if size > 1 else None,
            aim=Aim(most=AIMS[percent]) if size == MEASURED else None,
        )
        for percent in (50, 99)
        for size, found in joined.items()
    ]


def _costs(joined: dict[int, dict[str, Any]]) -> list[Figure]:
    one, many = joined[1], [(size, found) for size, found in joined.items() if size > 1]
    per_task = _per_task(one)
    figures = [Figure(name="CPU per task, 1 cell", unit="ms", ours=per_task)]
    figures += [
        Figure(
            name=f"CPU per task, {_cells(size)}",
            unit="ms",
            ours=_per_task(found),
            floor=per_task,
            aim=Aim(most=1.2),
        )
        for size, found in many
    ]
    return figures + [
        Figure(
            name=f"memory per cell, {_cells(size)}",
            unit="MB",
            ours=(found["memory"] - one["memory"]) / (size - 1) / MB,
            aim=Aim(most=1, of_ratio=False),
        )
        for size, found in many
    ]


def _per_task(found: dict[str, Any]) -> float:
    return float(found["process_s"]) / max(int(found["tasks"]), 1) * 1e3


@dataclass(frozen=True, kw_only=True)
class OverRos:
    """A plant over ROS 2: its reactions, and how long it took until it was heard and until all cells work."""

    reactions: Sequence[float]
    heard_s: float
    works_s: float


def _over_ros(scene: Scene, size: int) -> OverRos:
    scene.say(f"{size} cells over ROS 2")
    file = plants.write(scene.folder / f"ros_{size}.yaml", size)
    with CrewOnRos(file, move_s=_move_s(scene)) as crew:
        began = time.monotonic()
        node = scene.node("orchestrator", file)
        crew.wait_for_the_plant(node)
        heard_s = time.monotonic() - began
        crew.keep_busy()
        crew.wait_for_work()
        works_s = time.monotonic() - began
        reactions = crew.reactions_in(QUICK_S if scene.quick else ROS_S)
    scene.end()
    return OverRos(reactions=reactions, heard_s=heard_s, works_s=works_s)


def _reactions_over_ros(found: dict[int, OverRos]) -> list[Figure]:
    return [
        Figure(
            name=f"over ROS 2, reaction p{percent}, {_cells(size)}",
            unit="ms",
            ours=percentile(each.reactions, percent) * 1e3,
            floor=percentile(found[1].reactions, percent) * 1e3 if size > 1 else None,
        )
        for percent in (50, 99)
        for size, each in found.items()
    ]


def _starts(found: dict[int, OverRos]) -> list[Figure]:
    aims = {MEASURED: Aim(most=START_S, of_ratio=False)}
    heard = [
        Figure(name=f"start until heard, {_cells(size)}", unit="s", ours=each.heard_s, aim=aims.get(size))
        for size, each in found.items()
    ]
    return heard + [
        Figure(name=f"start until all cells work, {_cells(size)}", unit="s", ours=each.works_s)
        for size, each in found.items()
    ]


def _notes(scene: Scene, joined: dict[int, dict[str, Any]]) -> list[str]:
    shares = ", ".join(f"{found['load']:.0%} with {_cells(size)}" for size, found in joined.items())
    plant = ", ".join(f"{_of_plant(found):.2g} ms with {_cells(size)}" for size, found in joined.items())
    return [
        f"One process, robots included, takes of a core: {shares}.",
        f"The plant's thread alone takes per task: {plant}.",
        f"Moves take {_move_s(scene)} s, dwell times are the shipped plant's; every robot reports at 10 Hz.",
    ]


def _of_plant(found: dict[str, Any]) -> float:
    return float(found["plant_s"]) / max(int(found["tasks"]), 1) * 1e3


def _move_s(scene: Scene) -> float:
    return QUICK_MOVE_S if scene.quick else MOVE_S


def _cells(size: int) -> str:
    return f"{size} cell" if size == 1 else f"{size} cells"
