"""`make mutants`: plant small bugs in core and wire, one at a time, and see who finds them."""

from __future__ import annotations

import json
import os
import sys
from argparse import Namespace
from pathlib import Path

from rich.console import Console

from frame.telling import stopwatch
from frame.words import BAD_INPUT, parser

from . import argued, by_tests, report
from .judging import JUDGES, SIMULATOR, TESTS, Judging, Order
from .mutant import Mutant
from .report import Row
from .sources import Sources

ROOT = Path(__file__).parents[3]
SURVIVED, INTERRUPTED = 1, 130  # exit statuses


def main(arguments: list[str] | None = None) -> int:
    options = _options(arguments)
    console = Console(highlight=False)
    sources = Sources(ROOT)
    reasons = argued.reasons()
    if gone := argued.gone(reasons, sources.mutants):
        console.print(
            "equivalent.yaml argues for mutants that there are no more:", *gone, sep="\n", markup=False
        )
        return BAD_INPUT
    drawn = [each for each in sources.sample(len(sources.mutants), options.seed) if options.only in each.key]
    drawn = drawn[: options.sample]
    judges = (options.judge,) if options.judge else JUDGES
    judging = Judging(sources, options.state, tuple(options.tests))
    order = Order(mutants=drawn, judges=judges, seeds=options.seeds, jobs=options.jobs)
    complete = _judge(judging, order, console)
    rows = [_row(judging, mutant, order, reasons) for mutant in drawn]
    judged = [row for row in rows if row.tests or row.simulator]
    report.show(console, judged)
    if options.json is not None:
        about = {"seed": options.seed, "sample": len(drawn), "seeds": options.seeds, "complete": complete}
        options.json.write_text(json.dumps(report.as_json(judged, **about), indent=1))
    if not complete:
        return INTERRUPTED
    return SURVIVED if report.totals(judged)["killed_or_argued_percent"] < options.at_least else 0


def _judge(judging: Judging, order: Order, console: Console) -> bool:
    """True if it came to its end; Ctrl-C ends it with what was judged so far."""
    say = stopwatch()
    try:
        for number, verdict in enumerate(judging.run(order, console.print), start=1):
            word = "killed  " if verdict.killed else "survived"
            line = f"{number:4} {word} {verdict.judge:9} {verdict.cpu_s:6.1f} s"
            say(f"{line}  {verdict.key}  {verdict.by}")
    except KeyboardInterrupt:
        console.print("interrupted; what was judged is kept, the same command goes on")
        return False
    return True


def _row(judging: Judging, mutant: Mutant, order: Order, reasons: dict[str, str]) -> Row:
    tests, simulator = (
        judging.verdict(mutant, judge, order.seeds) if judge in order.judges else None
        for judge in (TESTS, SIMULATOR)
    )
    return Row(mutant=mutant, tests=tests, simulator=simulator, reason=reasons.get(mutant.key))


def _options(arguments: list[str] | None) -> Namespace:
    options = parser(__doc__, prog="make mutants", seed="draws which ones")
    options.add_argument("--sample", type=int, default=400, help="how many mutants are drawn")
    options.add_argument("--seeds", type=int, default=100, help="how many seeds the simulator gets for each")
    options.add_argument(
        "--jobs", type=int, default=os.cpu_count() or 1, help="how many processes judge at the same time"
    )
    options.add_argument("--judge", choices=JUDGES, help="have only this judge look")
    options.add_argument("--tests", nargs="+", default=by_tests.TESTS, help="folders of the tests that judge")
    options.add_argument(
        "--at-least", type=float, default=100.0, help="per cent killed or argued, else status 1"
    )
    options.add_argument("--only", default="", help="only mutants whose key has this in it")
    options.add_argument("--json", type=Path, help="a file that gets everything")
    options.add_argument("--state", type=Path, default=ROOT / ".mutation", help="where verdicts are kept")
    return options.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
