"""How many robot cycles `arboleda simulate` gets through in a second of one core.

A cycle is a task that was begun and ended, about 10 s of a real robot: 100 cycles per second are a thousand
times real time. Seconds are those that this process had on its core, so a busy machine changes little.

The floor is the same plants, boards, network and people for as many cycles, without faults and with nobody
who watches: no truth, record, trace or invariants. The ratio says what judging costs, whatever the machine
is. With faults fewer cycles fit into the same plant time, since cells wait for people: that row is not only
judging.

In full mode the notes say where the time goes, by part of the house. They come from cProfile, which makes
small functions look dearer than they are; what a library does (json, dataclasses, enum) is put down to its
caller.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from time import process_time

from arboleda.app.simulate.request import Request
from arboleda.app.simulate.setting import Setting, rules
from arboleda.core.errors import ArboledaError
from arboleda.simulator.people import Attendant, Customers
from arboleda.simulator.run import MINUTE_S
from arboleda.simulator.world import World

from .result import Aim, Figure, Result
from .scene import Scene
from .time_by_part import time_by_part

AIM = Aim(least=100, of_ratio=False)
SPINS = 5_000_000
Run = Callable[[Setting, int], int]


def run(scene: Scene) -> Result:
    count, cycles = (2, 25) if scene.quick else (6, 100)
    setting, seeds = Request(cycles=cycles).setting, range(1, count + 1)
    calm = replace(setting, level="none")
    scene.say("nobody watches")
    floor = _rate(_bare, calm, seeds)
    scene.say("judged, no faults")
    without = _rate(_judged, calm, seeds)
    scene.say("judged, normal faults")
    judged = _rate(_judged, setting, seeds)
    notes = [f"{count} seeds of {cycles} cycles, {len(rules())} invariants; {_empty_loops()}"]
    if not scene.quick:
        scene.say("where the time goes")
        notes += _where_the_time_goes(setting, seeds)
    figures = [_figure("no faults", without, floor), _figure("normal faults", judged, floor, AIM)]
    return Result(figures=figures, notes=notes)


def _figure(faults: str, ours: float, floor: float, aim: Aim | None = None) -> Figure:
    return Figure(name=f"judged, {faults}", unit="cycles/s", ours=ours, floor=floor, aim=aim)


def _rate(run: Run, setting: Setting, seeds: Iterable[int]) -> float:
    """Cycles per second of this process on its core."""
    begin = process_time()
    cycles = sum(run(setting, seed) for seed in seeds)
    return cycles / (process_time() - begin)


def _bare(setting: Setting, seed: int) -> int:
    """The floor; cycles done."""
    world = World(setting.plant(seed))
    customers = Customers(world, seed)
    Attendant(world, seed)
    while customers.cycles < setting.cycles:
        world.advance(MINUTE_S)
    return customers.cycles


def _judged(setting: Setting, seed: int) -> int:
    """As `arboleda simulate` does it: faults, truth, record, trace, every invariant; cycles done."""
    result = setting.run(seed)
    if result.broken:
        raise ArboledaError(f"seed {seed} breaks an invariant, so its cycles do not count: {result.broken}")
    return result.cycles


def _empty_loops() -> str:
    """How fast this Python is here: what one divides by to compare machines."""
    begin = process_time()
    for _ in range(SPINS):
        pass
    return f"{SPINS / (process_time() - begin) / 1e6:.0f} M empty loops per second on this machine"


def _where_the_time_goes(setting: Setting, seeds: Iterable[int]) -> list[str]:
    lines = time_by_part(lambda: [setting.run(seed) for seed in seeds])
    return ["where the time goes with normal faults (the profiler's own cost in it):", *lines]
