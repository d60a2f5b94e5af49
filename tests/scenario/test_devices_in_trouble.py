"""Declared devices on lines that lose, repeat, delay and reorder, with boots and boards that give up."""

from __future__ import annotations

from collections import Counter
from random import Random

import pytest

from arboleda.model.cell_states import CellState
from arboleda.model.messages import InternalError, TaskChanged, TaskState, Verb
from arboleda.recipes import Kit, parallel, recipe, work
from arboleda.rig.network import keeps_its_place
from arboleda.rig.world import BRIDGE, PLANT, World
from arboleda.sim.machine import MachineBody

from ..plants import made
from ..unit.kinds.station import plant

ENDED = (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED)
TASKS = 12
BOARD = "st_1"


@recipe("all")
def all_at_once(cell: Kit):  # type: ignore[no-untyped-def]
    station = cell.device("station")
    return parallel(station.light(on=True), station.go(), station.weigh())


warm = made("warm", lambda cell, station: work(station.go(), station.warm(celsius=40.5)))


MADE_TRUE = {"all": {"at": "right"}, "warm": {"at": "right", "celsius": 40.5}}
BEFORE = {"at": "left", "celsius": 20.0}  # as somebody puts the station back when a task begins


class Trouble:
    """A world in which every kind of trouble comes, drawn from a seed, until `end`."""

    def __init__(self, seed: int) -> None:
        self.chance = Random(seed)
        self.world = World(plant(all_at_once, warm))
        self.world.watchers.append(self._look)
        body = self.world.boards[BOARD].body
        assert isinstance(body, MachineBody)
        self.body = body
        self.ends: Counter[str] = Counter()
        self.states: Counter[TaskState] = Counter()
        clients = self.world.broker.clients.values()
        self.lines = [line for client in clients for line in (client.up, client.down)]
        for line in self.lines:
            line.troubles.append(self._late)
            line.reorders += 1

    def ask(self, task: str) -> None:
        self.world.request_task(task)
        self.world.settle()

    def hit(self) -> None:
        """One thing that goes wrong, or none."""
        world, body = self.world, self.body
        kind = self.chance.randrange(9)
        if kind < 3:
            world.crash((BOARD, BRIDGE, PLANT)[kind])
        elif kind == 3:
            world.stall(self.chance.choice((BOARD, BRIDGE, PLANT)), self.chance.random() * 4)
        elif kind == 4:
            world.stop_broker()
            world.advance(1.0)
            world.start_broker()
        elif kind == 5:
            body.fails = lambda goal: "atasco"
        else:
            body.fails = lambda goal: None

    def attend(self) -> None:
        """An operator who tries whatever may lead out."""
        for verb in (Verb.ABANDON, Verb.RELEASE, Verb.RESUME):
            self.world.request_verb(verb, "bench")
            self.world.settle()
            self.world.advance(1.0)

    def end(self) -> None:
        for line in self.lines:
            line.troubles.clear()
            line.reorders = 0
        self.body.fails = lambda goal: None
        for _ in range(TASKS):
            self.world.advance(20.0)
            self.attend()

    def _late(self, message: object) -> list[float]:
        if keeps_its_place(message):
            return [0.0]
        luck = self.chance.random()
        if luck < 0.05:
            return []
        if luck < 0.1:
            return [0.0, self.chance.random() * 0.5]
        return [self.chance.random() * 0.3 if luck < 0.3 else 0.0]

    def _look(self) -> None:
        for message in self.world.moment.sent:
            assert not isinstance(message, InternalError), message
            if isinstance(message, TaskChanged) and message.state is TaskState.RUNNING:
                self.body.facts.update(BEFORE)
            if isinstance(message, TaskChanged) and message.task and message.state in ENDED:
                self.ends[message.task] += 1
                self.states[message.state] += 1
                if message.state is TaskState.DONE:
                    made = MADE_TRUE[message.text.split()[1]]
                    assert {name: self.body.facts[name] for name in made} == made


@pytest.mark.sampled(4)
@pytest.mark.parametrize("seed", range(4))
def test_each_task_ends_once_and_done_is_true(seed: int) -> None:
    trouble = Trouble(seed)
    for number in range(TASKS):
        trouble.ask(f"bench {trouble.chance.choice(('all', 'warm'))} #t{number}")
        trouble.world.advance(trouble.chance.random() * 12)
        trouble.hit()
        trouble.attend()
    trouble.end()
    trouble.ask("bench all #last")
    trouble.world.advance(60.0)
    assert trouble.world.plant.cells["bench"].state is CellState.IDLE
    assert set(trouble.ends) >= {"last"}
    assert set(trouble.ends.values()) == {1}
    assert set(trouble.states) >= {TaskState.DONE, TaskState.FAILED}
