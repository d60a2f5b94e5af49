"""The same recipe as a py_trees tree that a timer ticks at 10 Hz and 100 Hz, against Arboleda.

In this table *ours* is the ticked tree (`ticked_tree.py`, plain ROS 2 and py_trees) and the *floor* is
Arboleda's own node in the same run, so a large ratio is what is aimed at. All have the same robots, the same
tasks and moves whose times fall evenly over a whole period of the slower tick: no move is in step with it.
"""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.plant_file.loader import load

from . import plants, steps
from .moments import milliseconds, reactions
from .result import Aim, Figure, Result, percentile
from .robots import DECLARED, Robots
from .scene import Scene
from .stage import Stage

SLOW_HZ, FAST_HZ = 10, 100
PAUSE_S = 0.01
SHORTEST_S = 0.03
LONGEST_S = SHORTEST_S + 1 / SLOW_HZ


def run(scene: Scene) -> Result:
    """Arboleda alone and both ticked trees beside each other, in turns."""
    turns, cycles = (2, 3) if scene.quick else (6, 10)
    timing = {"dwell_s": PAUSE_S, "effector_settle_s": PAUSE_S}
    every, ours = (
        plants.write(scene.folder / f"{cells}.yaml", cells, timing=timing, near=True, **DECLARED)
        for cells in (3, 1)
    )
    scene.say("starting")
    processes = [
        scene.node("orchestrator", ours),
        scene.python("arboleda_bench.ticked_tree", str(every), "c2", str(SLOW_HZ)),
        scene.python("arboleda_bench.ticked_tree", str(every), "c3", str(FAST_HZ)),
    ]
    model, move_s = load(every), steps.lengths(SHORTEST_S, LONGEST_S)
    with Stage(model.cells, lambda node: Robots(node, model, move_s), processes) as stage:
        arboleda, *trees = stage.cells
        for turn in range(turns):
            scene.say(f"turn {turn + 1} of {turns}")
            stage.play(cycles, arboleda)
            stage.play(cycles, *trees)
        return _result(*(milliseconds(reactions(stage.moments(cell))) for cell in stage.cells))


def _result(ours: Sequence[float], slow: Sequence[float], fast: Sequence[float]) -> Result:
    sides = ((SLOW_HZ, slow, 10), (FAST_HZ, fast, 1.5))
    figures = [
        Figure(
            name=f"{hertz} Hz ticked tree, p{percent}",
            unit="ms",
            ours=percentile(polled, percent),
            floor=percentile(ours, percent),
            aim=Aim(least=least) if percent == 50 else None,
        )
        for hertz, polled, least in sides
        for percent in (50, 99)
    ]
    return Result(
        figures=figures,
        notes=(
            "Here 'ours' is the ticked tree and 'floor' is Arboleda: the ratio is how many times longer a "
            "robot waits for a tree that is polled.",
            f"{len(ours)} transitions of Arboleda, {len(slow)} at {SLOW_HZ} Hz, {len(fast)} at {FAST_HZ} Hz; "
            f"moves of {SHORTEST_S * 1000:g} to {LONGEST_S * 1000:g} ms. Plant file as in reaction.",
        ),
    )
