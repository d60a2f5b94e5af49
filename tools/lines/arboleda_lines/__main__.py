"""Drivers at bad lines, in virtual time: each form of a line, each moment of an order, each act then.

A driver takes one to five minutes on two cores.
"""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Callable, Iterable
from multiprocessing import get_context

from frame.telling import counts, stopwatch
from frame.words import parser

from .drivers import TRIED
from .matrix import Outcome, cases_of, tried


def main() -> int:
    options = parser(__doc__, prog="tools/bad-lines")
    options.add_argument("drivers", nargs="*", metavar="DRIVER", help=f"{', '.join(TRIED)} [all]")
    options.add_argument(
        "--only", metavar="WORD", default="", help="cases with this word, as left_over or stop"
    )
    options.add_argument("--every", type=int, metavar="N", default=1, help="each so manieth case [1]")
    typed = options.parse_args()
    if unknown := [name for name in typed.drivers if name not in TRIED]:
        options.error(f"no driver is called {unknown[0]}; there are {', '.join(TRIED)}")
    say, wrong = stopwatch(), 0
    with get_context("fork").Pool(os.cpu_count()) as pool:
        for name in typed.drivers or TRIED:
            cases = [case for case in cases_of(name, TRIED[name]) if typed.only in str(case)]
            wrong += _tell(name, pool.imap(tried, cases[:: typed.every], chunksize=4), say)
    return 1 if wrong else 0


def _tell(name: str, outcomes: Iterable[Outcome], say: Callable[[str], None]) -> int:
    """Say what came of a driver's cases; returns how many broke."""
    ends, slowest_s = Counter[str](), 0.0
    for outcome in outcomes:
        ends["broken" if outcome.breaches else "held"] += 1
        slowest_s = max(slowest_s, outcome.stop_on_line_s or 0.0)
        for breach in outcome.breaches:
            say(f"{outcome.case}: {breach}")
    say(f"{name}: {counts(ends)}; a stop was on the line after {slowest_s:.3f} s at most")
    return ends["broken"]


if __name__ == "__main__":
    sys.exit(main())
