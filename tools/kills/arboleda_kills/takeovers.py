"""Take the leader from a plant with a standby again and again; count what came of its tasks.

    python -m arboleda_kills.takeovers --store postgresql://USER@HOST/DATABASE [--times 30] [--seed 1]

Two processes of the shipped plant on one database, one broker and one set of boards. A leader is killed with
-9, frozen (and thawed once the other one leads) or asked for a handover, at random instants of its work. Exit
status 1 where a task was lost, a part was taken up or set down twice, or dropped, where a robot moved before
anybody let it, or where a leader that was thawed did not step down.
"""

from __future__ import annotations

import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import psycopg

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.plant_file import loader
from arboleda.store.task_rows import TaskQuery
from arboleda_fleet.postgres.history import PostgresHistory
from arboleda_fleet.postgres.leadership import PostgresLeadership
from frame.telling import counts, told
from frame.words import parser

from .judge import Kill, judge
from .people import People, Said
from .processes import PATIENCE_S, UP, Boards, Plant, environment
from .summary import keep_wrong, spread, states

NAME, RATE, LATEST_S, LOOK_S = "arboleda", 8.0, 3.0, 0.02
WAYS = KILL, FREEZE, HANDOVER = "killed", "frozen", "handed-over"


class Takeovers:
    """Two hosts, their boards and their people."""

    def __init__(self, folder: Path, store: str, port: int, seed: int, ways: Sequence[str]) -> None:
        self._ways = ways
        self._folder, self._store = folder, store
        self._options = ("--store", store, "--broker", f"127.0.0.1:{port}")
        self._dice = random.Random(seed)
        self.boards = Boards(RATE, folder / "boards.log")
        self.boards.broker("127.0.0.1", port)
        cells = [cell for cell in loader.load(None).cells if cell.handover]
        self.people = People(self.boards, cells, self._dice, f"s{seed}-{int(time.time())}")
        self._others = PostgresLeadership(store, NAME)
        self._cells = [cell.name for cell in cells]
        self._starts = 0
        self.seconds: dict[str, list[float]] = {KILL: [], FREEZE: [], HANDOVER: []}
        self.kills: list[Kill] = []
        self.trouble: list[str] = []
        self.leader = self._up()
        self._led_at = self._answers(self.leader)

    def once(self) -> str:
        """One change of leaders, and what it was."""
        standby = self._up("--standby")
        self._until(lambda _: self._others.leader().standbys)
        self._until(lambda snapshot: any(cell["task"] for cell in snapshot["cells"]))
        end = time.time() + self._dice.random() * LATEST_S
        self._until(lambda _: time.time() >= end)
        how = self._dice.choice(self._ways)
        old, epoch = self.leader, self._others.leader().epoch
        at = time.time()
        asked = self._end(old, how)
        led_at = self._changed(epoch)
        free_at = at
        if asked is not None:
            said = asked.communicate(timeout=PATIENCE_S)[0]
            if asked.returncode:
                self.trouble.append(f"handover: {said.strip()}")
            free_at = led_at - float(said.rpartition("for ")[2].split()[0])
            self.people.attendant.acts += [
                Said(at=led_at, cell=cell, verb="resume", scope=cell, drops=False) for cell in self._cells
            ]
        self.seconds[how].append(led_at - free_at)
        self.kills.append(Kill(started_at=self._led_at, joined_at=self._led_at, killed_at=at))
        self._led_at = led_at
        self._see_off(old, how)
        self.leader = standby
        self._answers(standby)
        return how

    def finish(self) -> None:
        """Let all that is open end."""
        self.people.customers.bring = False
        self._until(lambda _: not self.people.customers.waiting)

    def close(self) -> None:
        self.leader.kill()
        self.boards.end()
        self._others.close()

    @property
    def last(self) -> Kill:
        return Kill(started_at=self._led_at, joined_at=self._led_at)

    def _up(self, *options: str) -> Plant:
        self._starts += 1
        name = f"host{self._starts}"
        log = self._folder / f"{name}.log"
        return Plant(self._folder / name, log, lambda *_: None, (*self._options, *options))

    def _end(self, old: Plant, how: str) -> subprocess.Popen[str] | None:
        if how == KILL:
            old.kill()
        elif how == FREEZE:
            old.freeze(on=True)
        else:
            command = [sys.executable, "-c", UP, "handover", "--store", self._store]
            return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment())
        return None

    def _see_off(self, old: Plant, how: str) -> None:
        """A leader that was thawed steps down and tells robots nothing; one that handed over ends well."""
        if how == KILL:
            return
        if how == FREEZE:
            old.freeze(on=False)
        status, words = old.ended()
        if status != (how == FREEZE) or (how == FREEZE and "steps down" not in words):
            self.trouble.append(f"{how}: status {status}, {words}")
        old.kill()

    def _changed(self, epoch: int) -> float:
        patience = time.time() + PATIENCE_S
        while time.time() < patience:
            leader = self._others.leader()
            if leader.epoch != epoch and leader.leads:
                return time.time()
            time.sleep(LOOK_S)
        raise TimeoutError(f"nobody took over within {PATIENCE_S:g} s")

    def _answers(self, plant: Plant) -> float:
        """Customers come back as soon as the plant answers, and no more the standby in its place."""
        patience = time.time() + PATIENCE_S
        while time.time() < patience:
            if plant.await_api(patience) and "cells" in plant.ask("GET", "/api/plant")[1]:
                self.people.customers.come_back(plant)
                return time.time()
            time.sleep(LOOK_S)
        raise TimeoutError(f"the plant did not answer within {PATIENCE_S:g} s")

    def _until(self, over: Callable[[dict[str, Any]], Any]) -> None:
        self.people.until(self.leader, over)


def main() -> int:
    options = parser(__doc__, seed="draws instants, ways and tasks")
    options.add_argument("--store", required=True, help="a database; the plant 'arboleda' in it is made anew")
    options.add_argument("--times", type=int, default=30)
    options.add_argument("--ways", nargs="*", choices=WAYS, help="of a change; all of them without")
    options.add_argument("--port", type=int, default=18_830, help="of the broker")
    wanted = options.parse_args()
    with psycopg.connect(wanted.store, autocommit=True) as db:
        db.execute(f"DROP SCHEMA IF EXISTS plant_{NAME} CASCADE")
    folder = Path(tempfile.mkdtemp(prefix="arboleda-takeovers-"))
    broker = EmbeddedBroker(port=wanted.port)
    broker.start()
    run = Takeovers(folder, wanted.store, wanted.port, wanted.seed, wanted.ways or WAYS)
    try:
        for number in range(wanted.times):
            how = run.once()
            print(f"{number + 1} of {wanted.times}: {how}, {run.seconds[how][-1]:.2f} s", flush=True)
        run.finish()
    except (Exception, KeyboardInterrupt) as error:  # noqa: BLE001 - what was done so far is judged
        run.trouble.append(f"{type(error).__name__}: {error}")
    finally:
        run.close()
        broker.stop()
    return _report(run, wanted.store, folder)


def _report(run: Takeovers, store: str, folder: Path) -> int:
    history = PostgresHistory(store, NAME)
    rows = history.select(TaskQuery(limit=None))
    history.close()
    customers, deeds, acts = run.people.customers, run.boards.deeds, run.people.attendant.acts
    accepted, ends = customers.accepted, customers.ends
    verdict = judge(rows, deeds, run.kills, acts, accepted=accepted, ends=ends, last=run.last)
    verdict.lost += customers.contradictions
    for how, times in run.seconds.items():
        if times:
            print(f"{how}: {len(times)}, {spread(times)}")
    print(f"{len(accepted)} tasks accepted: {counts(states(rows))}")
    wrong = {**verdict.wrong, "trouble": run.trouble}
    print("\n".join(told(wrong)))
    if any(wrong.values()):
        keep_wrong(folder, deeds, (*run.kills, run.last, *acts))
    return int(any(wrong.values()))


if __name__ == "__main__":
    sys.exit(main())
