"""From a robot's `motion_state` 0 to its receipt of the next command, over ROS 2 between two processes.

Ours is the shipped node `orchestrator`; the robots are in this process (`robots.py`). The floor
(`floor_reaction.py`) is a bare rclpy node that hears the same topics in the same executor and publishes a
message made beforehand from the last callback it needs. Both run all the time, with telemetry at 10 Hz, and
have tasks in turns, so what the machine does besides falls on both.
"""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.model.plant_model import APART_S
from arboleda.plant_file.loader import load

from . import plants, steps
from .moments import Reaction, kind, milliseconds, reactions
from .result import Aim, Figure, Result, percentile
from .robots import DECLARED, Robots
from .scene import Scene
from .stage import Stage

PAUSE_S = 0.01
SHORTEST_S, LONGEST_S = 0.03, 0.06


def run(scene: Scene) -> Result:
    """500 transitions of each side, or as many as a short look allows."""
    turns, cycles = (3, 4) if scene.quick else (13, 10)
    timing = {"dwell_s": PAUSE_S, "effector_settle_s": PAUSE_S}
    both, ours = (
        plants.write(scene.folder / f"{name}.yaml", cells, timing=timing, near=True, **DECLARED)
        for name, cells in (("both", 2), ("ours", 1))
    )
    scene.say("starting")
    processes = [
        scene.node("orchestrator", ours),
        scene.python("arboleda_bench.floor_reaction", str(both), "c2"),
    ]
    model, move_s = load(both), steps.lengths(SHORTEST_S, LONGEST_S)
    with Stage(model.cells, lambda node: Robots(node, model, move_s), processes) as stage:
        mine, floor = stage.cells
        for turn in range(turns):
            scene.say(f"turn {turn + 1} of {turns}")
            stage.play(cycles, floor)
            stage.play(cycles, mine)
        return _result(reactions(stage.moments(mine)), reactions(stage.moments(floor)))


def _result(ours: Sequence[Reaction], floor: Sequence[Reaction]) -> Result:
    figures = [
        figure("p50", 50, ours, floor, Aim(most=3.5)),
        figure("p99", 99, ours, floor, Aim(most=4)),
    ]
    for what in dict.fromkeys(kind(each) for each in ours):
        mine, bare = ([each for each in side if kind(each) == what] for side in (ours, floor))
        figures.append(figure(f"p50, {what}", 50, mine, bare))
    return Result(
        figures=figures,
        notes=(
            f"{len(ours)} transitions of ours, {len(floor)} of the floor, in turns; those that a declared "
            "pause lies in are not counted.",
            f"Plant file: link ros, evidence joints, poses close together, dwell_s and effector_settle_s "
            f"{PAUSE_S:g} s; moves of {SHORTEST_S * 1000:g} to {LONGEST_S * 1000:g} ms. "
            "An effector command of ours is on disk before it leaves, the floor keeps nothing. A drive of "
            f"ours ends with the report that proves it, {APART_S:g} s or more after its stop.",
        ),
    )


def figure(
    name: str, percent: int, ours: Sequence[Reaction], floor: Sequence[Reaction], aim: Aim | None = None
) -> Figure:
    mine, theirs = (percentile(milliseconds(side), percent) for side in (ours, floor))
    return Figure(name=name, unit="ms", ours=mine, floor=theirs, aim=aim)
