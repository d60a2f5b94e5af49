"""Fault after fault to a plant on several hosts, and what came of its tasks."""

from __future__ import annotations

import random
import time
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from arboleda.model.errors import ArboledaError
from arboleda.plant_file import loader
from arboleda.store.leadership import Leader
from arboleda.store.task_rows import TaskQuery, TaskRow
from arboleda_fleet.postgres.history import PostgresHistory
from arboleda_fleet.postgres.leadership import PostgresLeadership
from arboleda_fleet.postgres.schema import schema_of

from ..database import DATABASE, USER
from ..judge import Kill, Verdict, judge
from ..people import OVER, People, Said
from .books import keep_books, truly
from .cast import DATA, DATABASE_PORT, HOSTS, LEFT, RIGHT, UNHEARD, Cast, HostPlant
from .entrances import Ways
from .faults import Fault, Scene
from .network import Network
from .visitors import Visitors

NAME = "arboleda"
SCHEMA = schema_of(NAME)
STORE = f"postgresql://{USER}@127.0.0.1:{DATABASE_PORT}/{DATABASE}"  # on its own host
WELL_S = 90.0  # after a fault all robots are heard by then, and somebody waits
LOOK_S, PASS_S, ASK_S = 0.02, 0.05, 0.2
LATEST_S = 3.0  # so long after a task is at work the fault comes
SHORTEST_S, LONGEST_S = 0.5, 4.0  # of a fault after which the same process leads
QUIET_S = 120.0  # without an end of any task, nobody here knows what else to do
LED_S = 60.0  # by then somebody leads
SLACK_S = 0.5  # in which what two boards accepted may be told in another order
BROKEN = ("Traceback", "internal error")


class Run:
    """Hosts, processes and people; `close` ends them all."""

    def __init__(self, folder: Path, *, seed: int, rate: float) -> None:
        self._dice = random.Random(seed)
        model = loader.load(None)
        cells = [cell for cell in model.cells if cell.handover]
        self._cells = [cell.name for cell in cells]
        self.network = Network(HOSTS, folder)
        self.cast = Cast(self.network, folder, rate, list(model.robots))
        self._others = PostgresLeadership(STORE, NAME)
        self._people = People(self.cast.boards, cells, self._dice, f"s{seed}")
        self.customers, self.attendant = self._people.customers, self._people.attendant
        self.seconds: dict[str, list[float]] = {}
        self.counts: Counter[str] = Counter()
        self.ends: Counter[str] = Counter()
        self.kills: list[Kill] = []
        self.trouble: list[str] = []
        self._epoch = 0
        self._led_at = self._fault_at = time.time()
        self._leader: HostPlant | None = None
        self._greeted: HostPlant | None = None
        self._superseded: HostPlant | None = None
        self._last_news: tuple[int, ...] = ()
        self._patience = 0.0
        with self.network.inside(DATA):
            self._others.prepare()
            with self.cast.database.connection() as db:
                keep_books(db, SCHEMA)
        self._plants = {LEFT: self.cast.plant(LEFT, standby=False)}
        self._until(lambda _: True)
        self._plants[RIGHT] = self.cast.plant(RIGHT, standby=True)
        self.ways = Ways(self.network, self.cast, lambda: self._other)
        self.visitors = Visitors(cells, self.ways.all)

    def once(self, fault: Fault) -> str:
        """One fault, from work to work; what it was."""
        self._until(self._is_at_work)
        end = time.time() + self._dice.random() * LATEST_S
        self._until(lambda _: time.time() >= end)
        scene = self._scene()
        epoch, self._fault_at = self._epoch, time.time()
        over = fault.begin(scene)
        if fault.takes_over:
            took_s = self._taken_over(fault, epoch)
            told = f"{fault.name}: {scene.leader.host} to {scene.standby.host} in {took_s:.2f} s"
        else:
            time.sleep(SHORTEST_S + self._dice.random() * (LONGEST_S - SHORTEST_S))
            told = fault.name
        over()
        self.counts[fault.name] += 1
        self._recover(fault)
        return told if self._epoch == epoch or fault.takes_over else f"{told}; {self._plant.host} leads"

    def finish(self) -> None:
        """Let all that is open end."""
        self.customers.bring = self.visitors.bring = False
        self._until(lambda snapshot: not self.customers.waiting and self._is_idle(snapshot))
        self.trouble += self.ways.trouble

    def close(self) -> None:
        self.visitors.bring = False
        for plant in self._plants.values():
            plant.freeze(on=False)
            plant.kill()
        self._others.close()
        self.cast.close()
        self.network.close()

    def verdict(self) -> tuple[Verdict, list[str], Sequence[TaskRow]]:
        """Verdict on tasks and parts, leaders that moved something beside another one, and the history."""
        with self.network.inside(DATA):
            history = PostgresHistory(STORE, NAME)
            rows = history.select(TaskQuery(limit=None))
            history.close()
            with self.cast.database.connection() as db:
                rows = truly(db, SCHEMA, rows)
        customers, deeds, said = self.customers, self.cast.boards.deeds, self.attendant.acts
        visitors = self.visitors
        last = Kill(started_at=self._led_at, joined_at=self._led_at)
        found = judge(
            rows,
            deeds,
            self.kills,
            said,
            accepted=customers.accepted | visitors.accepted,
            ends=customers.ends | visitors.ends,
            last=last,
        )
        found.lost += customers.contradictions + visitors.contradictions
        return found, two_leaders(self.cast.watch.executed), rows

    @property
    def _plant(self) -> HostPlant:
        assert self._leader is not None
        return self._leader

    def _scene(self) -> Scene:
        return Scene(
            network=self.network, cast=self.cast, leader=self._plant, standby=self._other, dice=self._dice
        )

    @property
    def _other(self) -> HostPlant:
        return next(plant for plant in self._plants.values() if plant is not self._leader)

    def _is_idle(self, snapshot: dict[str, Any]) -> bool:
        """Nobody waits for anything, and all that was brought has ended."""
        return self.visitors.are_gone and all(task["state"] in OVER for task in snapshot["tasks"])

    def _is_at_work(self, snapshot: dict[str, Any]) -> bool:
        return self._is_well(snapshot) and any(cell["task"] for cell in snapshot["cells"])

    def _is_well(self, snapshot: dict[str, Any]) -> bool:
        """Every robot is heard, and somebody waits."""
        row = self._row()
        return row is not None and row.standbys > 0 and all(each["online"] for each in snapshot["robots"])

    def _recover(self, fault: Fault) -> None:
        """Until all is well again, with who ended in the place of the one that stood by."""
        patience = time.time() + WELL_S

        def over(snapshot: dict[str, Any]) -> bool:
            self._restart_ended(fault)
            if time.time() > patience:
                raise TimeoutError(f"{fault.name}: all was not well again within {WELL_S:g} s")
            return self._is_well(snapshot)

        self._until(over)

    def _taken_over(self, fault: Fault, epoch: int) -> float:
        patience = time.time() + LED_S
        while self._epoch == epoch:
            if time.time() > patience:
                raise TimeoutError(f"{fault.name}: nobody took over within {LED_S:g} s")
            self._look_for_leader()
            time.sleep(LOOK_S)
        took_s = self._led_at - self._fault_at
        self.seconds.setdefault(fault.name, []).append(took_s)
        if fault.name == "handover":  # whose cells go on by themselves
            self.attendant.acts += [
                Said(at=self._led_at, cell=cell, verb="resume", scope=cell, drops=False)
                for cell in self._cells
            ]
        return took_s

    def _restart_ended(self, fault: Fault) -> None:
        """Restart plants that ended, or are about to: each ends with a sentence, and only where it may."""
        stale = [plant for plant in self._plants.values() if self._is_over(plant)]
        for plant in stale:
            status, words = plant.ended()
            if status >= 0:
                self.ends[f"{fault.name}: status {status}, {words[-160:]}"] += 1
                if not fault.ends or any(each in words for each in BROKEN):
                    self.trouble.append(f"{fault.name}: {plant.host} ended with status {status}: {words}")
            plant.kill()
            self._plants[plant.host] = self.cast.plant(plant.host, standby=True)

    def _is_over(self, plant: HostPlant) -> bool:
        """True if it has ended, or led and was superseded: then it ends within some seconds."""
        if plant.runs and plant is not self._leader and plant is self._superseded:
            patience = time.time() + LED_S
            while plant.runs:
                if time.time() > patience:
                    self.trouble.append(f"{plant.host} did not step down within {LED_S:g} s")
                    plant.kill()
                time.sleep(LOOK_S)
        return not plant.runs

    def _row(self) -> Leader | None:
        with suppress(ArboledaError), self.network.inside(DATA):
            return self._others.leader()
        return None

    def _look_for_leader(self) -> None:
        row = self._row()
        if row is None or not row.leads or row.epoch == self._epoch:
            return
        plant = next((each for each in self._plants.values() if each.pid == row.process), None)
        if plant is None:
            return
        if self._epoch:
            self._superseded = self._leader
            self.kills.append(Kill(started_at=self._led_at, joined_at=self._led_at, killed_at=self._fault_at))
        self._epoch, self._leader, self._led_at = row.epoch, plant, time.time()

    def _until(self, over: Callable[[dict[str, Any]], bool]) -> None:
        """Let people do their part until it is over; TimeoutError where nothing happens any more."""
        self._patience, asked_at = time.time() + QUIET_S, 0.0
        while True:
            if time.time() - asked_at > ASK_S or self._leader is None:
                self._look_for_leader()
                asked_at = time.time()
            with suppress(*UNHEARD):
                snapshot = self._snapshot()
                if snapshot is not None:
                    if over(snapshot):
                        return
                    self._people.look(self._plant, snapshot)
            now = (*self._people.news, self._epoch)
            if now != self._last_news:
                self._last_news, self._patience = now, time.time() + QUIET_S
            if time.time() > self._patience:
                raise TimeoutError(f"nothing happened for {QUIET_S:g} s")
            time.sleep(PASS_S)

    def _snapshot(self) -> dict[str, Any] | None:
        """The view of the leader; customers come back to one that leads anew."""
        plant = self._leader
        if plant is None or not plant.runs:
            return None
        if self._greeted is not plant:
            if not plant.await_api(time.time() + PASS_S) or "cells" not in plant.ask("GET", "/api/plant")[1]:
                return None
            self.customers.come_back(plant)
            self._greeted = plant
        snapshot: dict[str, Any] = plant.ask("GET", "/api/plant")[1]
        return snapshot if "cells" in snapshot else None


def two_leaders(executed: Iterable[tuple[float, str, str]]) -> list[str]:
    """A sentence for each command of a leader that a board accepted after one of the next leader."""
    found, newest, first_at = [], 0, 0.0
    of_robot: dict[str, int] = {}
    for at, robot, id in sorted(executed):
        epoch = int(id.partition("-")[0])
        if epoch < of_robot.get(robot, 0) or (epoch < newest and at > first_at + SLACK_S):
            found.append(f"{robot} accepted {id} after a command of plant {newest}")
        if epoch > newest:
            newest, first_at = epoch, at
        of_robot[robot] = max(epoch, of_robot.get(robot, 0))
    return found
