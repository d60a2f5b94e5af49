"""Time by part of the house; the time of libraries is put down to their callers."""

from __future__ import annotations

import cProfile
import pstats
import time
from collections import Counter, defaultdict
from collections.abc import Callable
from typing import Any

PARTS = {  # what part of the house a file belongs to; the first that fits
    "/arboleda/sim/": "boards",
    "/arboleda/wire/": "wire and bridge",
    "/arboleda/model/": "plant",
    "/arboleda/dispatch/": "plant",
    "/arboleda/trees/": "plant",
    "/arboleda/resume/": "plant",
    "/arboleda/core/": "plant",
    "/arboleda/departures/": "plant",
    "/py_trees/": "plant",
    "/simulator/truth/": "truth",
    "/simulator/record": "record",
    "/simulator/invariants/": "invariants",
    "/simulator/judged_world.py": "invariants",
    "/simulator/trace.py": "trace",
    "/arboleda/rig/": "network and time",
    "/simulator/": "faults and people",
}
DEEPEST = 20  # callers above a library's function; beyond, nobody is to blame
Function = tuple[str, int, str]
Stats = dict[Function, Any]


def time_by_part(act: Callable[[], object]) -> list[str]:
    """A line per part, the dearest first: its share in per cent, and its three dearest functions'."""
    profiler = cProfile.Profile(time.process_time)  # what else runs on the machine costs no part anything
    profiler.runcall(act)
    stats: Stats = pstats.Stats(profiler).stats  # type: ignore[attr-defined]
    functions = _by_part(stats)
    own = Counter({name: sum(costs.values()) for name, costs in functions.items()})
    whole = sum(own.values())
    return [_line(name, seconds, functions[name], whole) for name, seconds in own.most_common()]


def _by_part(stats: Stats) -> dict[str, Counter[str]]:
    functions: defaultdict[str, Counter[str]] = defaultdict(Counter)
    for function, (_, _, seconds, _, _) in stats.items():
        for name, share in _shares(function, stats).items():
            functions[name][_label(function)] += seconds * share
    return functions


def _shares(function: Function, stats: Stats, above: tuple[Function, ...] = ()) -> dict[str, float]:
    """The shares of the parts to which a function's time is put down; 1 in all."""
    for path, name in PARTS.items():
        if path in function[0]:
            return {name: 1.0}
    callers = {each: edge[2] for each, edge in stats[function][4].items() if each not in above}
    whole = sum(callers.values())
    if not whole or len(above) > DEEPEST:
        return {"other": 1.0}
    found: Counter[str] = Counter()
    for caller, seconds in callers.items():
        for name, share in _shares(caller, stats, (*above, function)).items():
            found[name] += share * seconds / whole
    return dict(found)


def _label(function: Function) -> str:
    file, _, name = function
    return name if file in ("~", "<string>") else f"{file.rpartition('/')[2].removesuffix('.py')}.{name}"


def _line(name: str, seconds: float, functions: Counter[str], whole: float) -> str:
    top = ", ".join(f"{each} {100 * cost / whole:.1f}" for each, cost in functions.most_common(3))
    return f"  {name:<18} {100 * seconds / whole:5.1f} %   {top}"
