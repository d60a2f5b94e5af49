"""`make kills`: kill a plant with -9 at random instants over the real chain; count what came of its tasks.

The plant is `arboleda up` with the broker that it has by default. Its virtual boards live on in a process of
their own, with robots faster than the plant file says. Customers bring tasks, and ask for them again after
each start; an attendant does what the plant advises, as anybody reads it over HTTP.

Exit status 1 where a task was lost, a part was taken up or set down twice, or dropped, where a robot moved
before anybody let it, or where the plant ended by itself.
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
from argparse import Namespace
from pathlib import Path

from frame.telling import stopwatch

from . import report
from .campaign import Campaign
from .summary import options_of


def main(arguments: list[str] | None = None) -> int:
    options = _options(arguments)
    folder = options.keep or Path(tempfile.mkdtemp(prefix="arboleda-kills-"))
    folder.mkdir(parents=True, exist_ok=True)
    outcome = Campaign(
        folder, kills=options.kills, seed=options.seed, rate=options.rate, say=stopwatch()
    ).run()
    print("\n".join(report.lines(outcome)))
    if options.json is not None:
        options.json.write_text(json.dumps({"seed": options.seed} | report.as_json(outcome), indent=1))
    if not outcome.ok:
        print(f"memory, log and deeds are kept in {folder}")
    elif options.keep is None:
        shutil.rmtree(folder)
    return 0 if outcome.ok else 1


def _options(arguments: list[str] | None) -> Namespace:
    parser = options_of(__doc__, "kills", "kills", seed="draws instants and tasks")
    parser.add_argument("--json", type=Path, help="write what came of it there")
    parser.add_argument(
        "--keep",
        type=Path,
        help="a folder for the plant's memory, its log and the boards' deeds; without it they are kept where "
        "something was wrong",
    )
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
