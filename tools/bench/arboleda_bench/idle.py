"""The cost of a plant while nothing is to be done: with telemetry at 10 Hz, and with silent links.

Ours is the shipped node `orchestrator`, with two robots per cell at evidence `ids`. This process plays their
bridge: it publishes on every topic of `mqtt_bridge`, ten times a second per robot, values that do not change.
The floor (`floor_idle.py`) is a bare rclpy node with the same subscriptions, executor and loop, whose
callbacks are empty. Both run at the same time and hear the same messages.

Silent: the same 100 cells once nothing is published any more, every robot counts as offline, and screens
have been shown that: the view of 100 cells that have all changed is made in slices, for some 2 s.
"""

from __future__ import annotations

import time

from . import plants
from .crew_ros import CrewOnRos
from .processes import Process
from .result import Aim, Figure, Result
from .scene import Scene

SIZES, QUICK_SIZES = (1, 10, 100), (100,)
WINDOW_S, QUICK_WINDOW_S = 10.0, 2.5
SETTLE_S = 1.0
NOTE = "Processor time as a share of one core. Nobody listens to /plant/view and /diagnostics meanwhile."
REST_S = 6.0  # robots are offline 1.5 s after their last word, and the view of that follows


def run(scene: Scene) -> Result:
    figures: list[Figure] = []
    rates: list[str] = []
    for size in QUICK_SIZES if scene.quick else SIZES:
        found, rate = _measured(scene, size)
        figures += found
        rates.append(rate)
    heard = f"Statuses per second that both heard, by cells: {', '.join(rates)}."
    return Result(figures=figures, notes=(NOTE, heard))


def _measured(scene: Scene, size: int) -> tuple[list[Figure], str]:
    """The figures of so many cells, and the number of messages published meanwhile."""
    scene.say(f"{size} idle cells")
    file = plants.write(scene.folder / f"plant_{size}.yaml", size)
    floor = scene.python("arboleda_bench.floor_idle", str(file))
    ours = scene.node("orchestrator", file)
    with CrewOnRos(file) as crew:
        floor.read()
        crew.wait_for_the_plant(ours)
        time.sleep(SETTLE_S)
        told = crew.crew.repeats
        fed, bare = _loads(scene, ours, floor)
        rate = (crew.crew.repeats - told) / _window_s(scene)
        figures = [_figure(size, fed, bare)]
        if size == max(SIZES):
            scene.say(f"{size} silent cells")
            crew.fall_silent()
            time.sleep(REST_S)
            figures.append(_silent(size, _loads(scene, ours)[0]))
    scene.end()
    return figures, f"{rate:.0f} with {size}"


def _figure(size: int, ours: float, floor: float) -> Figure:
    name = f"{size} cell{'s' if size > 1 else ''} with telemetry"
    return Figure(name=name, unit="% of a core", ours=ours, floor=floor, aim=Aim(most=1.3 if size > 1 else 2))


def _silent(size: int, ours: float) -> Figure:
    aim = Aim(most=1, of_ratio=False)
    return Figure(name=f"{size} cells with silent links", unit="% of a core", ours=ours, aim=aim)


def _loads(scene: Scene, *processes: Process) -> list[float]:
    """The load of each process over one window, in per cent of a core."""
    began, before = time.monotonic(), [each.cpu_s for each in processes]
    time.sleep(_window_s(scene))
    lasted = time.monotonic() - began
    return [100 * (each.cpu_s - had) / lasted for each, had in zip(processes, before, strict=True)]


def _window_s(scene: Scene) -> float:
    return QUICK_WINDOW_S if scene.quick else WINDOW_S
