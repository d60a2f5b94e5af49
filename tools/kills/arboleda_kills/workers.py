"""Kill workers that share the seeds of a campaign; hold what came of the seeds against a run alone.

    python -m arboleda_kills.workers --store postgresql://USER@HOST/DATABASE [--seeds 300] [--workers 3]

Now and then one of the workers is killed with -9 and another one started in its place. At the end each seed
must have been done once, and its digest be the one that `arboleda simulate` comes to alone; exit status 1
where that is not so. Seeds of earlier campaigns in that database are deleted.
"""

from __future__ import annotations

import json
import random
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import psycopg

from arboleda_fleet.postgres.seeds import SCHEMA, SeedRows
from frame.telling import told
from frame.words import parser

from .processes import UP, environment

HERE = Path(__file__).parent
SHORT = HERE / "short_seeds.yaml"
PLANT = HERE.parents[2] / "examples/own_driver/plant.yaml"
LOOK_S = 0.1
COUNTED = (  # a row for each time that a seed was done, in the transaction that says so
    f"CREATE TABLE {SCHEMA}.done (seed BIGINT)",
    f"CREATE FUNCTION {SCHEMA}.count_done() RETURNS TRIGGER LANGUAGE plpgsql AS"
    f" $$ BEGIN INSERT INTO {SCHEMA}.done VALUES (NEW.seed); RETURN NEW; END $$",
    f"CREATE TRIGGER counted AFTER UPDATE ON {SCHEMA}.seed"
    f" FOR EACH ROW EXECUTE FUNCTION {SCHEMA}.count_done()",
)


@dataclass(frozen=True, kw_only=True)
class Shared:
    """Results of the workers: by seed its digest and how often it was done; how many of them died."""

    digests: dict[int, str]
    times: dict[int, int]
    kills: int
    seconds: float


def differences(shared: Shared, alone: dict[int, str]) -> list[str]:
    """Differences from the results of one process, a sentence each."""
    found = []
    for seed in sorted(alone.keys() | shared.digests.keys()):
        times = shared.times.get(seed, 0)
        if times != 1:
            found.append(f"seed {seed} was done {times} times")
        ours, theirs = alone.get(seed), shared.digests.get(seed)
        if ours != theirs:
            found.append(f"seed {seed}: {theirs} by the workers, {ours} alone")
    return found


class Workers:
    """Processes that work off a campaign, one of which dies now and then."""

    def __init__(self, store: str, options: list[str], folder: Path, dice: random.Random) -> None:
        self._store, self._options, self._folder, self._dice = store, options, folder, dice
        self._started = self._kills = 0

    def run(self, workers: int, every_s: float) -> Shared:
        began = time.monotonic()
        self._prepare()
        running = [self._worker() for _ in range(workers)]
        try:
            self._kill_until_done(running, every_s)
        finally:
            for each in running:
                each.kill()
                each.wait()
        return self._shared(time.monotonic() - began)

    def _kill_until_done(self, running: list[subprocess.Popen[bytes]], every_s: float) -> None:
        kill_at = time.monotonic() + self._dice.uniform(0.5, 1.5) * every_s
        while all(each.poll() is None for each in running):  # a worker ends when all seeds are done
            time.sleep(LOOK_S)
            if time.monotonic() >= kill_at:
                kill_at = time.monotonic() + self._dice.uniform(0.5, 1.5) * every_s
                self._replace(running, self._dice.randrange(len(running)))
        for each in running:
            each.wait()

    def _replace(self, running: list[subprocess.Popen[bytes]], number: int) -> None:
        running[number].kill()
        if running[number].wait() == -signal.SIGKILL:  # else it had just ended by itself
            self._kills += 1
            running[number] = self._worker()

    def _worker(self) -> subprocess.Popen[bytes]:
        self._started += 1
        command = [*simulate(self._options), "--store", self._store, "--worker"]
        with (self._folder / f"worker{self._started}.log").open("wb") as log:
            return subprocess.Popen(command, stdout=log, stderr=log, env=environment())

    def _prepare(self) -> None:
        with psycopg.connect(self._store) as db:
            db.execute(f"DROP SCHEMA IF EXISTS {SCHEMA} CASCADE")
        rows = SeedRows(self._store, "")
        rows.lay_out(1, 0)
        rows.close()
        with psycopg.connect(self._store) as db:
            for statement in COUNTED:
                db.execute(statement)

    def _shared(self, seconds: float) -> Shared:
        with psycopg.connect(self._store) as db:
            rows = db.execute(f"SELECT seed, digest FROM {SCHEMA}.seed").fetchall()
            done = db.execute(f"SELECT seed, count(*) FROM {SCHEMA}.done GROUP BY seed").fetchall()
        return Shared(digests=dict(rows), times=dict(done), kills=self._kills, seconds=seconds)


def alone(options: list[str], jobs: int, folder: Path) -> dict[int, str]:
    """The digests that one command comes to, without a database."""
    file = folder / "alone.json"
    command = [*simulate(options), "--jobs", str(jobs), "--json", str(file)]
    ended = subprocess.run(command, capture_output=True, text=True, env=environment())
    if not file.exists():
        sys.exit(f"the run alone came to nothing: {ended.stderr}{ended.stdout}")
    return {row["seed"]: row["digest"] for row in json.loads(file.read_text())["seeds"]}


def simulate(options: list[str]) -> list[str]:
    return [sys.executable, "-c", UP, "simulate", *options]


def main() -> int:
    options_of = parser(__doc__)
    options_of.add_argument("--store", required=True, help="a database; its campaigns are deleted")
    options_of.add_argument("--first", type=int, default=1, help="the first seed")
    options_of.add_argument("--seeds", type=int, default=300)
    options_of.add_argument("--workers", type=int, default=3)
    options_of.add_argument("--every", type=float, default=5.0, help="s between two kills, in the mean")
    options_of.add_argument("--jobs", type=int, default=1, help="processes of the run alone")
    wanted = options_of.parse_args()
    count = ["--seed", str(wanted.first), "--seeds", str(wanted.seeds)]
    options = ["--plant", str(PLANT), "--faults", str(SHORT), *count]
    with tempfile.TemporaryDirectory(prefix="arboleda-workers-") as name:
        folder = Path(name)
        shared = Workers(wanted.store, options, folder, random.Random(1)).run(wanted.workers, wanted.every)
        print(
            f"{len(shared.digests):,} seeds by {wanted.workers} workers in {shared.seconds:.0f} s,"
            f" {shared.kills} of them killed with -9 meanwhile",
            flush=True,
        )
        expected = alone(options, wanted.jobs, folder)
    found = differences(shared, expected)
    print(f"{len(expected):,} seeds alone, {len(set(expected.values())):,} different digests")
    print("\n".join(told({"differences": found})))
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
