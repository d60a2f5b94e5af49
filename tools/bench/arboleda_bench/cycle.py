"""A whole storage cycle with 0.3 s moves against the sum of its moves and declared pauses.

Ours runs from `system/start` to the end of the last move, with the pauses of a plant file that sets none. The
floor is what nobody can save: the moves as the robots really took them, and the pauses that the recipe
declares, one after the start, and `effector_settle_s` and one more for each of the two effector commands.
"""

from __future__ import annotations

from collections.abc import Sequence

from std_msgs.msg import UInt8

from arboleda.model.plant_model import Timing
from arboleda.plant_file.loader import load
from arboleda_ros import qos

from . import plants
from .clockwork import now
from .moments import Cycle, cycles
from .result import Aim, Figure, Result
from .robots import DECLARED, Robots
from .scene import Scene
from .stage import Stage

MOVE_S = 0.3
EFFECTOR_COMMANDS = 2


def run(scene: Scene) -> Result:
    """A few tasks in one cell, each as its robots and `system/start` saw it."""
    plant = plants.write(scene.folder / "plant.yaml", 1, near=True, **DECLARED)
    model = load(plant)
    scene.say("starting")
    orchestrator = scene.node("orchestrator", plant)
    with Stage(model.cells, lambda node: Robots(node, model, lambda: MOVE_S), [orchestrator]) as stage:
        starts: list[float] = []
        stage.node.create_subscription(UInt8, "system/start", lambda _: starts.append(now()), qos.COMMAND)
        for number in range(tasks := 1 if scene.quick else 15):
            scene.say(f"task {number + 1} of {tasks}")
            stage.play(1, stage.cells[0])
        return _result(starts, cycles(stage.moments(stage.cells[0])), model.timing)


def _result(starts: Sequence[float], found: Sequence[Cycle], timing: Timing) -> Result:
    pauses_s = timing.dwell_s + EFFECTOR_COMMANDS * (timing.effector_settle_s + timing.dwell_s)
    ours = sum(cycle.ended_at - start for start, cycle in zip(starts, found, strict=True)) / len(found)
    floor = sum(cycle.moves_s for cycle in found) / len(found) + pauses_s
    return Result(
        figures=[
            Figure(name="storage cycle", unit="s", ours=ours, floor=floor, aim=Aim(most=1.02)),
            Figure(name="more than its parts", unit="ms", ours=1000 * (ours - floor)),
        ],
        notes=(
            f"Mean of {len(found)} cycles, each of 5 moves and {pauses_s:g} s of declared pauses "
            "(dwell_s and effector_settle_s as they are by default); the first move drives the mobile robot "
            "back to the start of its path.",
        ),
    )
