"""The number of robot cycles that `arboleda simulate` gets through in a second of one core.

The plants are files of the benchmark's own, as the shipped ones change: `racks` on odd seeds, and `zones`,
where arms get into each other's way, on even ones.

A cycle is a task that was begun and ended, about 10 s of a real robot: 100 cycles per second are a thousand
times real time. Seconds are those that this process had on its core, so a busy machine changes little.

The floor is the same plants, boards, network and people for as many cycles, without faults and with nobody
who watches: no truth, record, trace or invariants. The ratio says what judging costs, whatever the machine
is. With faults fewer cycles fit into the same plant time, since cells wait for people: that row is not only
judging.

Python looks for garbage as rarely as in the workers of the command, for the floor too.

In full mode the notes say where the time goes, by part of the house. They come from cProfile, which makes
small functions look dearer than they are; what a library does (json, dataclasses, enum) is put down to its
caller.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from time import process_time

from arboleda.extension import ArboledaError
from arboleda.plant_file import loader
from arboleda.rig.world import World
from arboleda_proofs.campaigns.plants import Plant, PlantRotation
from arboleda_proofs.campaigns.request import Request
from arboleda_proofs.campaigns.setting import Setting
from arboleda_proofs.campaigns.workers import collect_rarely
from arboleda_proofs.simulator.judged import INVARIANTS
from arboleda_proofs.simulator.people import Attendant, Customers
from arboleda_proofs.simulator.run import MINUTE_S

from .result import Aim, Figure, Result
from .scene import Scene
from .time_by_part import time_by_part

AIM = Aim(least=0.25)
SPINS = 5_000_000
PLANTS = ("zones", "racks")
Run = Callable[[Setting, int], tuple[int, float]]  # (setting, seed) -> (cycles, s of plant time)


@dataclass(frozen=True, kw_only=True)
class Timed:
    """One seed of a plant with so many cells: its cycles, s of plant time, s of a core."""

    plant: str
    cells: int
    cycles: int
    seconds: float
    core_s: float


def run(scene: Scene) -> Result:
    count, cycles = (2, 25) if scene.quick else (6, 100)
    setting, seeds = Request(source=_plants(), cycles=cycles).setting, range(1, count + 1)
    calm = replace(setting, level="none")
    with _few_collections():
        scene.say("nobody watches")
        floor = _timed(_bare, calm, seeds)
        scene.say("judged, no faults")
        without = _timed(_judged, calm, seeds)
        scene.say("judged, normal faults")
        judged = _timed(_judged, setting, seeds)
    notes = [
        f"{count} seeds of {cycles} cycles, {len(INVARIANTS)} invariants; {_empty_loops()}",
        *_by_plant(judged),
    ]
    if not scene.quick:
        scene.say("where the time goes")
        notes += _where_the_time_goes(setting, seeds)
    figures = [_figure("no faults", without, floor), _figure("normal faults", judged, floor, AIM)]
    return Result(figures=figures, notes=notes)


def _plants() -> PlantRotation:
    folder = Path(__file__).with_name("simulated")
    loaded = (loader.load_with_files(folder / f"{name}.yaml") for name in PLANTS)
    return PlantRotation(plants=tuple(Plant(declared=model, files=read) for model, read in loaded))


def _figure(faults: str, ours: Sequence[Timed], floor: Sequence[Timed], aim: Aim | None = None) -> Figure:
    name, unit = f"judged, {faults}", "cycles/s"
    return Figure(name=name, unit=unit, ours=_rate(ours), floor=_rate(floor), aim=aim)


def _by_plant(runs: Sequence[Timed]) -> list[str]:
    """A line for each plant: cycles differ from plant to plant, and with them their number per second."""
    lines = []
    for plant in dict.fromkeys(run.plant for run in runs):
        own = [run for run in runs if run.plant == plant]
        cycles, seconds = sum(run.cycles for run in own), sum(run.seconds for run in own)
        cells, core_s = own[0].cells, sum(run.core_s for run in own)
        lines.append(
            f"plant {plant} with normal faults: {_rate(own):.0f} cycles/s, {seconds / core_s:.0f} times real "
            f"time; its {cells} cells end a cycle every {seconds / cycles:.1f} s"
        )
    return lines


def _timed(run: Run, setting: Setting, seeds: Iterable[int]) -> list[Timed]:
    """The runs of these seeds, each with the seconds that it kept this process on its core."""
    runs = []
    for seed in seeds:
        model, begin = setting.plant(seed), process_time()
        cycles, seconds = run(setting, seed)
        core_s = process_time() - begin
        timed = Timed(plant=model.name, cells=len(model.cells), cycles=cycles, seconds=seconds, core_s=core_s)
        runs.append(timed)
    return runs


def _rate(runs: Sequence[Timed]) -> float:
    """Cycles per second of a core."""
    return sum(run.cycles for run in runs) / sum(run.core_s for run in runs)


@contextmanager
def _few_collections() -> Iterator[None]:
    usual = gc.get_threshold()
    collect_rarely()
    try:
        yield
    finally:
        gc.set_threshold(*usual)
        gc.unfreeze()


def _bare(setting: Setting, seed: int) -> tuple[int, float]:
    """Run the floor; return the number of cycles, and the s of plant time."""
    world = World(setting.plant(seed))
    began = world.now
    customers = Customers(world, seed)
    Attendant(world, seed)
    while customers.cycles < setting.cycles:
        world.advance(MINUTE_S)
    return customers.cycles, world.now - began


def _judged(setting: Setting, seed: int) -> tuple[int, float]:
    """Run as `arboleda simulate` does: with faults, truth, record, trace, and every invariant."""
    result = setting.run(seed)
    if result.broken:
        raise ArboledaError(f"seed {seed} breaks an invariant, so its cycles do not count: {result.broken}")
    return result.cycles, result.seconds


def _empty_loops() -> str:
    """The speed of this Python on this machine, by which figures of machines can be compared."""
    begin = process_time()
    for _ in range(SPINS):
        pass
    return f"{SPINS / (process_time() - begin) / 1e6:.0f} M empty loops per second on this machine"


def _where_the_time_goes(setting: Setting, seeds: Iterable[int]) -> list[str]:
    lines = time_by_part(lambda: [setting.run(seed) for seed in seeds])
    return ["where the time goes with normal faults (the profiler's own cost in it):", *lines]
