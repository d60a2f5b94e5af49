"""`make hosts`: a plant on hosts of its own, each a network namespace, under faults of hosts and links.

Two hosts for plants, one that leads and one that stands by, and one each for PostgreSQL, the MQTT broker, the
bridge (over DDS) and the virtual boards. Faults at random instants of work: kill -9, freezes, a handover,
links that are cut in one direction or both, that are late and lose packets, database, broker and bridge that
are restarted or crash, wall clocks that are stepped on one host. Tasks come to who leads, and from a
host without a plant: by commands, and by the address of who stands by.

Exit status 1 where a task was lost, a part was taken up or set down twice, or dropped, where a robot moved
before anybody let it, where boards accepted a command of one leader after one of the next, or where something
ended that should not. Status 2 where this machine makes no network namespaces. It needs root, iproute2,
postgresql, mosquitto and gcc.
"""

from __future__ import annotations

import json
import random
import shutil
import sys
import tempfile
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

from arboleda.runtime.interrupts import interruptible
from frame.telling import counts, stopwatch, told

from ..database import NoServer, programs
from ..summary import keep_wrong, options_of, spread, states
from .clocks import NoCompiler
from .faults import CLOCKS, FAULTS
from .namespaces import NoNamespaces
from .run import Run

NOT_HERE = 2


def main() -> int:
    wanted = _options()
    folder = Path(tempfile.mkdtemp(prefix="arboleda-hosts-"))
    folder.chmod(0o755)  # the broker gives up its rights
    with interruptible():
        return _tried(wanted, folder, stopwatch())


def _tried(wanted: Namespace, folder: Path, say: Callable[[str], None]) -> int:
    try:
        programs()
        if shutil.which("mosquitto") is None:
            raise NoServer("mosquitto is not installed")
        run = Run(folder, seed=wanted.seed, rate=wanted.rate)
    except (NoServer, NoCompiler) as error:
        print(f"something is missing, so nothing was tried: {error}")
        return NOT_HERE
    except NoNamespaces as error:
        print(f"no network namespaces here, so nothing was tried: {error}")
        return 0 if wanted.if_possible else NOT_HERE
    faults = [fault for fault in FAULTS if not wanted.only or fault.name in wanted.only]
    dice = random.Random(wanted.seed)
    try:
        rounds = [fault for _ in range(wanted.faults) for fault in dice.sample(faults, len(faults))]
        for number, fault in enumerate(rounds[: wanted.faults], start=1):
            say(f"{number} of {wanted.faults}: {run.once(fault)}")
        run.finish()
    except (Exception, KeyboardInterrupt) as error:  # noqa: BLE001 - what was done so far is judged
        run.trouble.append(f"{type(error).__name__}: {error}")
    status = 1
    try:
        status = _report(run, folder)
    finally:
        run.close()
        if status == 0 and not wanted.keep:
            shutil.rmtree(folder, ignore_errors=True)
    return status


def _report(run: Run, folder: Path) -> int:
    verdict, beside, rows = run.verdict()
    for name, times in sorted(run.seconds.items()):
        print(f"{name}: {len(times)}, {spread(times)}")
    print(f"faults: {counts(dict(sorted(run.counts.items())))}")
    print(f"{len(rows)} tasks accepted: {counts(states(rows))}")
    visitors, ways = run.visitors, run.ways
    print(f"of them sent from another host: {dict(visitors.sent)}; followed: {dict(ways.followed)}")
    for (way, words), count in sorted((visitors.refused + ways.looked).items()):
        print(f"refused or broken off {count} times {way}: {words[:300]}")
    for words, count in sorted(run.ends.items()):
        print(f"ended {count} times after {words}")
    wrong = {**verdict.wrong, "two leaders": beside, "trouble": run.trouble}
    print("\n".join(told(wrong)))
    if any(wrong.values()):
        (folder / "seen.jsonl").write_text("".join(f"{json.dumps(row)}\n" for row in run.cast.watch.executed))
        keep_wrong(folder, run.cast.boards.deeds, (*run.kills, *run.attendant.acts))
    return int(any(wrong.values()))


def _options() -> Namespace:
    parser = options_of(__doc__, "hosts", "faults", seed="draws faults, instants and tasks")
    names = [fault.name for fault in FAULTS]
    parser.add_argument(
        "--only", nargs="*", choices=names, metavar="FAULT", help="; ".join(names).replace("%", "%%")
    )
    parser.add_argument(
        "--only-clocks",
        action="store_const",
        const=[each.name for each in CLOCKS],
        dest="only",
        help="those that step clocks",
    )
    parser.add_argument("--keep", action="store_true", help="keep the logs also where all is well")
    parser.add_argument(
        "--if-possible", action="store_true", help="status 0 also where there are no namespaces"
    )
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
