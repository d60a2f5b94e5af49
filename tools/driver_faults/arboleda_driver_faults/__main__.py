"""One driver, seed by seed, under the faults of its virtual controller.

Usage: tools/driver-faults DRIVER [SEEDS] [FIRST]

The plant's core, the supervisor of drivers and the driver are the shipped ones; device and time are
virtual. A breach is printed with its seed, and the status is 1.
"""

from __future__ import annotations

import sys
import time
from collections import Counter

from frame.telling import counts
from frame.words import words

from .rig import run
from .rigs import RIGS, maker_of


def main() -> int:
    usage = f"usage: tools/driver-faults {' | '.join(RIGS)} [SEEDS] [FIRST]"
    rig, seeds, first = words(usage, maker_of, 200, 0)
    began = time.perf_counter()
    ends, faults, wrong = Counter[str](), Counter[str](), 0
    for seed in range(first, first + seeds):
        result = run(rig(), seed)
        faults.update(each.name for each in result.faults)
        ends.update(each.reason.value if each.reason else each.state.value for each in result.ended)
        for breach in result.breaches:
            wrong += 1
            print(f"seed {seed} ({', '.join(each.name for each in result.faults)}): {breach}")
    print(f"faults: {counts(dict(sorted(faults.items())))}")
    print(f"tasks: {counts(dict(ends.most_common()))}")
    print(f"{seeds} seeds in {time.perf_counter() - began:.0f} s: {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
