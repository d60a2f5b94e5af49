"""Cost lock: counts the Python calls of pinned scenarios, and fails where there are more than 2 % more.

It counts the different functions of each act, too: those that are touched once cost most in cold memory.

    make cost                       compare with the table in tools/bench/arboleda_bench/cost
    make cost COST="--only view"    the scenarios whose names have this in them
    make cost COST=--pin            write the table anew; the commit says why something is dearer

Exit status: 0 nothing is dearer, 1 something is, 2 the words of the call are wrong or nothing is pinned.
"""

from __future__ import annotations

import argparse
import os
import sys
from itertools import islice

from .counter import Calls, count
from .scenarios import SCENARIOS, Scenario
from .table import Comparison, Cost, file_for, read, write

DEARER, UNUSABLE = 1, 2
PYTHON = f"{sys.version_info.major}.{sys.version_info.minor}"


def main() -> int:
    """Count, and compare or pin; return the exit status."""
    options = _options()
    names = [name for name in SCENARIOS if options.only in name]
    file = file_for(PYTHON)
    pinned = read(file)
    if not names:
        return _refuse(f"no scenario has {options.only!r} in its name; there are:\n" + "\n".join(SCENARIOS))
    if not pinned and not options.pin:
        return _refuse(f"nothing is pinned for Python {PYTHON}; `make cost COST=--pin` does it")
    costs: dict[str, Cost] = {}
    dearer = []
    print("       calls          different           scenario")
    for name in names:
        costs[name] = Cost.of(cost_of(SCENARIOS[name]))
        row = Comparison(name=name, pinned=pinned.get(name), now=costs[name])
        print(_line(row), flush=True)
        dearer += [row] if row.is_dearer else []
    if options.pin:
        write(file, {name: (pinned | costs)[name] for name in SCENARIOS if name in pinned | costs})
        print(f"pinned in {file.name}")
        return 0
    for row in dearer:
        print(_finding(row), file=sys.stderr)
    return DEARER if dearer else 0


def cost_of(scenario: Scenario) -> list[Calls]:
    """The calls of each act of a scenario.

    The first act is played once before, uncounted, so that caches are filled.
    """
    for act in islice(scenario(), 1):
        act()
    return [count(act) for act in scenario()]


def _line(row: Comparison) -> str:
    if row.pinned is None:
        return f"{row.now.calls:>12,}     new {row.now.different:>8,}     new  {row.name}"
    advice = "  (cheaper: pin it, so that it stays so)" if row.is_cheaper else ""
    different = f"{row.now.different:>8,} {100 * row.spread:>+6.1f} %"
    return f"{row.now.calls:>12,} {100 * row.growth:>+6.1f} % {different}  {row.name}{advice}"


def _finding(row: Comparison) -> str:
    if row.pinned is None:
        return f"{row.name}: nothing is pinned for it; `make cost COST=--pin` does it"
    calls = f"{row.now.calls:,} calls, pinned {row.pinned.calls:,} ({100 * row.growth:+.1f} %)"
    different = f"{row.now.different:,} different functions, pinned {row.pinned.different:,}"
    head = f"{row.name}: {calls}; {different}"
    return "\n  ".join([head, *row.grown()])


def _refuse(why: str) -> int:
    print(f"cost: {why}", file=sys.stderr)
    return UNUSABLE


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="make cost", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", default="", metavar="WORDS", help="scenarios whose names have this in them")
    parser.add_argument("--pin", action="store_true", help="write the table anew")
    return parser.parse_args()


def _run() -> int:
    if os.environ.get("PYTHONHASHSEED") != "0":  # the order of sets decides how much some code looks at
        os.environ["PYTHONHASHSEED"] = "0"
        os.execv(sys.executable, [sys.executable, "-m", "arboleda_bench.cost", *sys.argv[1:]])
    try:
        return main()
    except KeyboardInterrupt:
        print("\ninterrupted; nothing was pinned", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(_run())
