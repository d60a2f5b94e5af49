"""Start, kill, start again: the rounds, and what they left to judge."""

from __future__ import annotations

import random
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import httpx

from arboleda.plant_file import loader
from arboleda.runtime.state import STORE
from arboleda.store.task_rows import TaskHistory, TaskQuery, TaskRow

from .damages import unnoticed
from .judge import Kill, Verdict, judge
from .people import ROUND_S, People
from .processes import PATIENCE_S, Boards, Ended, Plant
from .summary import keep_deeds, states

AT_START = 0.1  # of the kills: while the plant starts
LATEST_S = 3.0  # of the others: so long after a task is at work


@dataclass(kw_only=True)
class Outcome:
    """Outcome of a campaign.

    `api_s`, `boards_s`: how long each start took until its API answered, and until every robot was heard.
    `damages`: how often a file of the memory was damaged in a copy after a kill. `unnoticed`: after which of
    them a start would know less than people were told. `trouble`: why it came to no good end.
    """

    kills: list[Kill] = field(default_factory=list)
    at_start: int = 0
    damages: int = 0
    unnoticed: list[str] = field(default_factory=list)
    api_s: list[float] = field(default_factory=list)
    boards_s: list[float] = field(default_factory=list)
    seconds: float = 0.0
    tasks: dict[str, int] = field(default_factory=dict)
    accepted: int = 0
    verbs: dict[str, int] = field(default_factory=dict)
    refused: list[str] = field(default_factory=list)
    verdict: Verdict = field(default_factory=Verdict)
    trouble: list[str] = field(default_factory=list)

    @property
    def ok(self) -> bool:
        return self.verdict.ok and not self.trouble and not self.unnoticed


class Campaign:
    """`kills` kills of a plant in `folder`, at instants that the seed draws."""

    def __init__(
        self, folder: Path, *, kills: int, seed: int, rate: float, say: Callable[[str], None]
    ) -> None:
        self._folder, self._state, self._log = folder, folder / "state", folder / "plant.log"
        self._wanted, self._say = kills, say
        self._dice = random.Random(seed)
        self._boards = Boards(rate, folder / "boards.log")
        cells = [cell for cell in loader.load(None).cells if cell.handover]
        self._people = People(self._boards, cells, self._dice, f"s{seed}")
        self._outcome = Outcome()

    def run(self) -> Outcome:
        """All of it; Ctrl-C ends it, and what was done so far is judged."""
        began, last = time.time(), Kill(started_at=0.0, joined_at=float("inf"))
        try:
            try:
                while len(self._outcome.kills) < self._wanted:
                    self._round()
            except KeyboardInterrupt:
                self._say("interrupted: what is open comes to its end")
            last = self._last_round()
        except (Ended, TimeoutError, httpx.HTTPError, KeyboardInterrupt) as error:
            self._outcome.trouble.append(str(error) or type(error).__name__)
        finally:
            self._boards.end()
        self._outcome.seconds = time.time() - began
        self._judge(last)
        return self._outcome

    def _round(self) -> None:
        """One start and its kill."""
        plant = self._start()
        at_start = self._dice.random() < AT_START and bool(self._outcome.api_s)
        share = self._dice.random()
        try:
            if at_start:
                longest = 1.5 * sorted(self._outcome.api_s)[len(self._outcome.api_s) // 2]
                _sleep_until(plant.started_at + share * longest)
                plant.check()
            else:
                self._until_ready(plant)
                self._people.until(plant, lambda snapshot: any(cell["task"] for cell in snapshot["cells"]))
                end = time.time() + share * LATEST_S
                self._people.until(plant, lambda _: time.time() >= end - ROUND_S)
                _sleep_until(end)
                plant.check()
        finally:
            killed_at = time.time()
            plant.kill()
            self._boards.leave()
        self._damage()
        rows = self._rows(is_open=True)
        running = frozenset(row.id for row in rows if row.state == "running")
        kill = Kill(
            started_at=plant.started_at, joined_at=plant.joined_at, killed_at=killed_at, running=running
        )
        self._outcome.kills.append(kill)
        self._outcome.at_start += at_start
        when = "while it started" if at_start else f"{share * LATEST_S:.2f} s into work"
        self._say(f"kill {len(self._outcome.kills)} of {self._wanted}, {when}: {len(running)} at work")

    def _damage(self) -> None:
        """Damage copies of what the kill has left of the memory, in each way."""
        customers = self._people.customers
        tried, silent = unnoticed(self._state, customers.accepted, customers.ends, self._dice)
        self._outcome.damages += tried
        self._outcome.unnoticed += silent

    def _last_round(self) -> Kill:
        """Start once more and let all that is open end."""
        self._people.customers.bring = False
        plant = self._start()
        try:
            self._until_ready(plant)
            self._people.until(plant, lambda _: not self._people.customers.waiting)
            if status := plant.interrupt():
                self._outcome.trouble.append(f"the plant ended on Ctrl-C with status {status}")
        finally:
            plant.kill()
            self._boards.leave()
        return Kill(started_at=plant.started_at, joined_at=plant.joined_at)

    def _start(self) -> Plant:
        return Plant(self._state, self._log, self._boards.broker)

    def _until_ready(self, plant: Plant) -> None:
        """Customers come back as soon as somebody answers; ready it is with all its robots."""
        if not plant.await_api(time.time() + PATIENCE_S):
            raise TimeoutError(f"the plant did not answer within {PATIENCE_S:g} s")
        self._outcome.api_s.append(time.time() - plant.started_at)
        self._people.customers.come_back(plant)
        self._people.until(plant, lambda snapshot: all(robot["online"] for robot in snapshot["robots"]))
        self._outcome.boards_s.append(time.time() - plant.started_at)

    def _rows(self, *, is_open: bool | None = None) -> list[TaskRow]:
        history = TaskHistory(self._state / STORE)
        try:
            return history.select(TaskQuery(is_open=is_open, limit=-1))
        finally:
            history.close()

    def _judge(self, last: Kill) -> None:
        outcome, customers, attendant = self._outcome, self._people.customers, self._people.attendant
        keep_deeds(self._folder, self._boards.deeds)
        rows = self._rows()
        outcome.verdict = judge(
            rows,
            self._boards.deeds,
            outcome.kills,
            attendant.acts,
            accepted=customers.accepted,
            ends=customers.ends,
            last=last,
        )
        outcome.verdict.lost += customers.contradictions
        outcome.accepted = len(customers.accepted)
        outcome.tasks = states(rows)
        outcome.verbs = dict(sorted(Counter(each.verb for each in attendant.acts).items()))
        outcome.refused = attendant.refused
        outcome.trouble += [f"nobody here can {each}" for each in sorted(attendant.stuck)]


def _sleep_until(at: float) -> None:
    time.sleep(max(0.0, at - time.time()))
