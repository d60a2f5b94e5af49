"""People around the plant: customers who come back for their ids, an attendant who follows advice."""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.model.advice import Hand
from arboleda.model.messages import Verb
from arboleda.model.plant_model import Cell

from .processes import Boards, Plant

ROUND_S = 0.05  # between two looks
QUIET_S = 60.0  # without an end of any task, nobody here knows what else to do
WAITING = 2  # tasks of each cell that have not ended
AGAIN = 3  # ended tasks that are asked for once more after each start
OVER = frozenset({"done", "failed", "cancelled"})
BY_THEMSELVES = frozenset({Hand.BRING_BACK.value})
AT_THE_BOARD = {Hand.REFERENCE.value: "reference", Hand.REPAIR.value: "repair"}
BY_HAND = {Verb.HOME.value: "reference", Verb.RELEASE.value: "empty"}
ACCEPTED = 202


@dataclass(frozen=True, kw_only=True)
class Said:
    """A verb that the attendant said, and what it was for."""

    at: float
    cell: str
    verb: str
    scope: str
    drops: bool


class Customers:
    """Each cell gets the next task as soon as one of its tasks has ended, until they `bring` no more.

    `accepted`: id to text of what the plant said it has. `ends`: id to the end that it said, which may never
    change; `contradictions` says where it did.
    """

    def __init__(self, cells: Sequence[Cell], dice: random.Random, name: str) -> None:
        self._cells = cells
        self._dice = dice
        self._name = name
        self._count = 0
        self._texts: dict[str, str] = {}  # by id, whether or not an answer came
        self._of_cell: dict[str, set[str]] = {cell.name: set() for cell in cells}  # those that have not ended
        self.bring = True
        self.accepted: dict[str, str] = {}
        self.ends: dict[str, str] = {}
        self.contradictions: list[str] = []

    @property
    def waiting(self) -> bool:
        """True if a task of theirs has not ended."""
        return any(self._of_cell.values())

    def come_back(self, plant: Plant) -> None:
        """Ask again for all that has not ended, also where no answer came, and for some that has."""
        some = self._dice.sample(sorted(self.ends), min(AGAIN, len(self.ends)))
        for id in [*sorted(set().union(*self._of_cell.values())), *some]:
            self._ask(plant, id)

    def look(self, plant: Plant, snapshot: dict[str, Any]) -> None:
        """Take in what ended, and bring what is next."""
        for task in snapshot["tasks"]:
            if task["id"] in self._texts:
                self._note(task["id"], task["state"])
        for cell in self._cells if self.bring else ():
            while len(self._of_cell[cell.name]) < WAITING:
                self._ask(plant, self._next(cell))

    def _next(self, cell: Cell) -> str:
        self._count += 1
        id = f"{self._name}-{self._count}"
        path, station = self._dice.choice([*cell.paths]), self._count % len(cell.stations)
        self._texts[id] = f"{cell.name} {path} {station}"
        self._of_cell[cell.name].add(id)
        return id

    def _ask(self, plant: Plant, id: str) -> None:
        status, answer = plant.ask("POST", "/api/tasks", {"text": f"{self._texts[id]} #{id}"})
        if status != ACCEPTED:
            self.contradictions.append(f"{id} ({self._texts[id]}) was not accepted: {answer['sentence']}")
            self._forget(id)
            return
        self.accepted[id] = self._texts[id]
        self._note(id, answer["state"])

    def _note(self, id: str, state: str) -> None:
        if state in OVER:
            self._forget(id)
        if self.ends.get(id, state) != state:
            self.contradictions.append(f"{id} was {self.ends[id]} and then {state}")
        elif state in OVER:
            self.ends[id] = state

    def _forget(self, id: str) -> None:
        for ids in self._of_cell.values():
            ids.discard(id)


class Attendant:
    """Does, cell by cell, the first thing that is advised; `stuck`: what nobody here can do."""

    def __init__(self, boards: Boards) -> None:
        self._boards = boards
        self.acts: list[Said] = []
        self.stuck: set[str] = set()
        self.refused: list[str] = []

    def look(self, plant: Plant, snapshot: dict[str, Any]) -> None:
        for cell in snapshot["cells"]:
            self._see_to(plant, cell)

    def _see_to(self, plant: Plant, cell: dict[str, Any]) -> None:
        """The first; who has looked into a zone also says so, as the plant cannot know."""
        for advice in cell["advice"]:
            if advice["refusal"] is not None or advice["do"] in BY_THEMSELVES:
                return
            if advice["do"] in AT_THE_BOARD:
                self._boards.act({AT_THE_BOARD[advice["do"]]: advice["scope"]})
            elif advice["hand"] and advice["do"] != Hand.CHECK.value:
                self.stuck.add(advice["said"])
            elif not advice["hand"]:
                self._say(plant, cell["name"], advice)
            if advice["do"] != Hand.CHECK.value:
                return

    def _say(self, plant: Plant, cell: str, advice: dict[str, Any]) -> None:
        """Say a verb; who declares what was done by hand has done that before."""
        verb, scope, drops = advice["do"], advice["scope"], bool(advice["drops"])
        if advice["by_hand"]:
            self._boards.act({BY_HAND[verb]: scope})
            drops = verb == Verb.RELEASE.value
        self.acts.append(Said(at=time.time(), cell=cell, verb=verb, scope=scope, drops=drops))
        status, answer = plant.ask(
            "POST", f"/api/cells/{scope}/{verb}", {"by_hand": True} if advice["by_hand"] else None
        )
        if status >= 400:
            self.refused.append(f"{verb} {scope}: {answer['sentence']}")


class People:
    """Customers and attendant of a plant."""

    def __init__(self, boards: Boards, cells: Sequence[Cell], dice: random.Random, name: str) -> None:
        self.customers = Customers(cells, dice, name)
        self.attendant = Attendant(boards)

    @property
    def news(self) -> tuple[int, int]:
        """Another one as soon as a task has ended or a verb was said."""
        return len(self.customers.ends), len(self.attendant.acts)

    def look(self, plant: Plant, snapshot: dict[str, Any]) -> None:
        self.customers.look(plant, snapshot)
        self.attendant.look(plant, snapshot)

    def until(self, plant: Plant, over: Callable[[dict[str, Any]], Any]) -> None:
        """Do their part until it is over; TimeoutError where nothing happens any more."""
        seen, patience = (-1, 0), time.time() + QUIET_S
        while True:
            plant.check()
            _, snapshot = plant.ask("GET", "/api/plant")
            if over(snapshot):
                return
            self.look(plant, snapshot)
            if self.news != seen:
                seen, patience = self.news, time.time() + QUIET_S
            if time.time() > patience:
                raise TimeoutError(f"nothing happened for {QUIET_S:g} s: {_standing(snapshot)}")
            time.sleep(ROUND_S)


def _standing(snapshot: dict[str, Any]) -> str:
    return "; ".join(
        f"{cell['name']} is {cell['state']}, advised is {[each['said'] for each in cell['advice']]}"
        for cell in snapshot["cells"]
    )
