"""From a board's word that it is done to its receipt of the next command: bridge, orchestrator and back.

Ours are the shipped nodes `mqtt_bridge` and `orchestrator`, two processes, with a mosquitto between them and
the boards, which are in this process (`boards.py`). In the floor (`floor_chain.py`) a bare rclpy node stands
in the orchestrator's place: it reads `/{robot}/status` and publishes the next command from that callback.
Both use the same bridge and broker, run all the time and have tasks in turns.
"""

from __future__ import annotations

from arboleda.adapters.broker_login import address
from arboleda.plant_file.loader import load

from . import plants, steps
from .boards import DECLARED, Boards
from .moments import reactions
from .reaction import LONGEST_S, SHORTEST_S, figure
from .result import Aim, Result
from .scene import Scene
from .stage import Stage

PAUSE_S = 0.01


def run(scene: Scene) -> Result:
    """500 transitions of each side, or as many as a short look allows."""
    turns, cycles = (3, 4) if scene.quick else (13, 10)
    both, ours = (
        plants.write(scene.folder / f"{name}.yaml", cells, timing={"dwell_s": PAUSE_S}, near=True, **DECLARED)
        for name, cells in (("both", 2), ("ours", 1))
    )
    scene.say("starting")
    broker = scene.mosquitto()
    processes = [
        scene.node("mqtt_bridge", both, broker=broker),
        scene.node("orchestrator", ours),
        scene.python("arboleda_bench.floor_chain", str(both), "c2"),
    ]
    model, move_s = load(both), steps.lengths(SHORTEST_S, LONGEST_S)
    with Stage(model.cells, lambda _: Boards(model, address(broker), move_s), processes) as stage:
        mine, floor = stage.cells
        for turn in range(turns):
            scene.say(f"turn {turn + 1} of {turns}")
            stage.play(cycles, floor)
            stage.play(cycles, mine)
        found = [reactions(stage.moments(cell)) for cell in (mine, floor)]
    return Result(
        figures=[figure(f"p{percent}", percent, found[0], found[1], Aim(most=1.6)) for percent in (50, 99)],
        notes=(
            f"{len(found[0])} transitions of ours, {len(found[1])} of the floor, in turns. Each passes the "
            "broker, the bridge and ROS 2 twice.",
            f"Plant file: link mqtt, evidence ids, poses close together, dwell_s {PAUSE_S:g} s; moves of "
            f"{SHORTEST_S * 1000:g} to {LONGEST_S * 1000:g} ms.",
        ),
    )
