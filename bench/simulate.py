"""How many robot cycles the simulator gets through in a second of one core, and where the time goes.

.venv/bin/python bench/simulate.py [--seeds N] [--cycles N] [--no-profile]
"""

from __future__ import annotations

import argparse
import cProfile
import platform
import pstats
import sys
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable
from dataclasses import replace
from time import perf_counter, process_time

from arboleda.app.simulate.request import Request
from arboleda.app.simulate.setting import Setting, rules
from arboleda.simulator.people import Attendant, Customers
from arboleda.simulator.run import MINUTE_S
from arboleda.simulator.world import World

SPINS = 5_000_000
PARTS = {  # what part of the house a file belongs to; the first that fits
    "/arboleda/sim/": "boards",
    "/arboleda/wire/": "wire and bridge",
    "/arboleda/core/": "plant",
    "/py_trees/": "plant",
    "/simulator/truth/": "truth",
    "/simulator/record": "record",
    "/simulator/invariants/": "invariants",
    "/simulator/watched.py": "invariants",
    "/simulator/trace.py": "trace",
    "/simulator/world.py": "network and time",
    "/simulator/network.py": "network and time",
    "/simulator/": "faults and people",
}
Function = tuple[str, int, str]


def bare(setting: Setting, seed: int) -> int:
    """The floor: the same plant, boards, network and people; no faults, nobody watches. Cycles done."""
    world = World(setting.plant(seed))
    customers = Customers(world, seed)
    Attendant(world, seed)
    while customers.cycles < setting.cycles:
        world.advance(MINUTE_S)
    return customers.cycles


def judged(setting: Setting, seed: int) -> int:
    """As `arboleda simulate` does it: faults, truth, record, trace, every invariant. Cycles done."""
    result = setting.run(seed)
    if result.broken:
        print(f"  seed {seed} is broken and cut short: {result.broken}")
    return result.cycles


def measure(
    run: Callable[[Setting, int], int], setting: Setting, seeds: Iterable[int]
) -> tuple[float, float]:
    """Cycles per second of wall clock, and of this process on its core."""
    wall, core = perf_counter(), process_time()
    cycles = sum(run(setting, seed) for seed in seeds)
    return cycles / (perf_counter() - wall), cycles / (process_time() - core)


def spin() -> float:
    """Rounds of an empty loop per second of the core, in millions: how fast this Python is here."""
    begin = process_time()
    for _ in range(SPINS):
        pass
    return SPINS / (process_time() - begin) / 1e6


def profile(setting: Setting, seeds: Iterable[int]) -> None:
    """Where the time goes, by part of the house; what libraries do counts for who called them."""
    profiler = cProfile.Profile()
    profiler.enable()
    for seed in seeds:
        setting.run(seed)
    profiler.disable()
    stats = pstats.Stats(profiler).stats  # type: ignore[attr-defined]
    own: Counter[str] = Counter()
    functions: defaultdict[str, Counter[str]] = defaultdict(Counter)
    for function, (_, _, seconds, _, _) in stats.items():
        for name, share in shares(function, stats).items():
            own[name] += seconds * share
            functions[name][label(function)] += seconds * share
    whole = sum(own.values())
    print("\nwhere the time goes (with the profiler's own cost in it):")
    for name, seconds in own.most_common():
        top = ", ".join(f"{each} {100 * s / whole:.1f}" for each, s in functions[name].most_common(3))
        print(f"  {name:<18} {100 * seconds / whole:5.1f} %   {top}")


def shares(function: Function, stats: dict, above: tuple[Function, ...] = ()) -> dict[str, float]:
    """Which parts the time of a function is to be put down to; 1 in all."""
    for path, name in PARTS.items():
        if path in function[0]:
            return {name: 1.0}
    callers = {each: edge[2] for each, edge in stats[function][4].items() if each not in above}
    whole = sum(callers.values())
    if not whole or len(above) > 20:
        return {"other": 1.0}
    found: Counter[str] = Counter()
    for caller, seconds in callers.items():
        for name, share in shares(caller, stats, (*above, function)).items():
            found[name] += share * seconds / whole
    return dict(found)


def label(function: Function) -> str:
    file, _, name = function
    return name if file in ("~", "<string>") else f"{file.rpartition('/')[2].removesuffix('.py')}.{name}"


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--seeds", type=int, default=6, help="how many, half of them on each plant")
    parser.add_argument("--cycles", type=int, default=100, help="of each seed, at least")
    parser.add_argument("--no-profile", action="store_true", help="leave out where the time goes")
    options = parser.parse_args()
    setting, seeds = Request(cycles=options.cycles).setting, range(1, options.seeds + 1)
    print(f"Python {platform.python_version()}, {platform.machine()}, {spin():.0f} M empty loops per second")
    print(f"{len(seeds)} seeds, {options.cycles} cycles each, {len(rules())} invariants, one core\n")
    print(f"{'cycles per second':<34}{'wall':>8}{'core':>8}{'of floor':>10}")
    rows = {
        "floor: nobody watches, no faults": (bare, setting),
        "judged, no faults": (judged, replace(setting, level="none")),
        "judged, normal faults": (judged, setting),
    }
    floor = 0.0
    for name, (run, where) in rows.items():
        wall, core = measure(run, where, seeds)
        floor = floor or core
        print(f"{name:<34}{wall:>8.0f}{core:>8.0f}{core / floor:>10.2f}")
        sys.stdout.flush()
    if not options.no_profile:
        profile(setting, seeds)


if __name__ == "__main__":
    main()
