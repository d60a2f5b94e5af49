"""Scenarios of the cost lock: the work that a plant does again and again, each from a beginning of its own.

A scenario yields the acts to count, one after the other; its work between two of them is not counted.
"""

from __future__ import annotations

import asyncio
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from itertools import repeat
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import httpx
from starlette.types import ASGIApp, Receive, Scope, Send

from arboleda.adapters import clock
from arboleda.drivers import Command, MoveJoints, Report
from arboleda.engine import Plant
from arboleda.extension import Role
from arboleda.model.messages import OperatorRequest, TaskRequest, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load
from arboleda.recorder.state import state_of
from arboleda.recorder.steps import Step, as_json
from arboleda.rig.world import World
from arboleda.runtime.parts.local_plant import LocalPlant
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.store.sqlite import IN_MEMORY, Store
from arboleda.store.task_rows import TaskHistory
from arboleda.views import view
from arboleda.views.resting_cells import RestingCells
from arboleda.web.api import make_app
from arboleda_proofs.campaigns.request import Request
from arboleda_proofs.simulator.people import Attendant, Customers
from arboleda_proofs.simulator.run import MINUTE_S

from .. import plants
from ..obedient import EPOCH, Yard, command_in, is_over
from ..step import begin_task, go_on, leads_on, until_a_move
from .counter import stop_counting

Act = Callable[[], object]
Scenario = Callable[[], Iterator[Act]]
TIMES = 10
SEEDS, CYCLES = 10, 1
FURTHER_RAD = 1e-4
TEXT = "c1 0B 7"


def repeated_reports(cells: int) -> Iterator[Act]:
    """Steps with a report that says nothing new."""
    yield from _reports(cells, by_rad=0.0)


def moving_reports(cells: int) -> Iterator[Act]:
    """Steps with a report of an arm that has moved on."""
    yield from _reports(cells, by_rad=FURTHER_RAD)


def ends_of_moves(cells: int) -> Iterator[Act]:
    """Steps with a report that ends a move, which the next command follows."""
    yard = Yard(_model(cells))
    out = begin_task(yard)
    while not is_over(out):
        command = command_in(out)
        if command is None or not leads_on(yard, command):
            out = go_on(yard, command)
            continue
        yard.step(yard.accepts(command))
        report = yard.finishes(command)
        made: list[Any] = []
        yield partial(_step_into, made, yard, report)
        out = made


def _step_into(made: list[Any], yard: Yard, report: Report) -> None:
    made.extend(yard.step(report))


def from_reports() -> Iterator[Act]:
    """The way from a report that ends a command to the next one, in a plant whose memory is a file."""
    yard = Yard(_model(1, dwell_s=0))
    with (
        _time_stands(),
        tempfile.TemporaryDirectory() as folder,
        Store(Path(folder) / "plant.sqlite") as store,
    ):
        port, plant = Port(), WholePlant(yard.plant.model, EPOCH, _crash, store)
        plant.connect(port)
        plant.step(*yard.words.values(), TaskRequest(at=0.0, text=TEXT))
        port.sent = stop_counting
        command = port.commands.pop()
        while not isinstance(command, MoveJoints) or leads_on(yard, command):
            plant.step(yard.accepts(command))
            yield partial(plant.step, yard.finishes(command))
            command = port.commands.pop()


def waking() -> Iterator[Act]:
    """Wakings of a tree that waits for a move."""
    yard = Yard(_model(1))
    until_a_move(yard)
    run = yard.plant.cells["c1"].run
    assert run is not None
    for _ in range(TIMES):
        yield run.tick


def first_task() -> Iterator[Act]:
    """A plant from its making to the first command of its first task."""
    yield partial(_first_command, _model(1, dwell_s=0))


def _first_command(model: PlantModel) -> None:
    assert command_in(begin_task(Yard(model))) is not None


def views(cells: int) -> Iterator[Act]:
    """Views after one cell has changed."""
    yard, resting = Yard(_model(cells)), RestingCells()
    out = begin_task(yard)
    view.snapshot(yard.plant, resting.part)
    while not is_over(out):
        out = go_on(yard, command_in(out))
        yield partial(view.snapshot, yard.plant, resting.part)


def stops(cells: int) -> Iterator[Act]:
    """Stops of all cells, of which one is at work, and the same said again."""
    yard = Yard(_model(cells))
    until_a_move(yard)
    for _ in range(2):
        yield partial(yard.step, OperatorRequest(at=yard.now, verb=Verb.STOP))


def recorded_steps() -> Iterator[Act]:
    """Records of the flight recorder for the steps of a task."""
    yard = Yard(_model(1))
    out = begin_task(yard)
    while not is_over(out):
        command = command_in(out)
        out = go_on(yard, command)
        events = tuple(yard.words.values())
        yield partial(_recorded, yard.plant, yard.now, events, tuple(out))


def _recorded(plant: Plant, now: float, events: tuple[Any, ...], messages: tuple[Any, ...]) -> bytes:
    return as_json(Step(0, now, events, messages, state_of(plant, 1)))


def from_http() -> Iterator[Act]:
    """A task from its HTTP request to its first command, in a plant that keeps it."""
    model = _model(1, dwell_s=0)
    with _time_stands(), Store(IN_MEMORY) as store:
        port = Port()
        plant = WholePlant(model, EPOCH, _crash, store)
        plant.connect(port)
        plant.step(*Yard(model).words.values())
        transport = httpx.ASGITransport(app=Logged(make_app(LocalPlant(plant, TaskHistory(Path("none"))))))
        client = httpx.AsyncClient(transport=transport, base_url="http://plant")
        yield lambda: asyncio.run(_ask_by_http(client, plant, port))


@contextmanager
def _time_stands() -> Iterator[None]:
    """A clock of the plant that stands still: on a busy machine, silence would be noticed and screens drawn
    within an act. It answers without a Python call, as the real one does.
    """
    now = clock.seconds()
    still = SimpleNamespace(clock_gettime={clock.BOOT: now}.__getitem__, monotonic=repeat(now).__next__)
    with patch.object(clock, "time", still):
        yield


class WholePlant(Orchestrator):
    """A plant that nothing is asked of but by HTTP; `heard` is called after each event."""

    heard: Callable[[], object] = staticmethod(lambda: None)
    due = 0.0

    def hear(self, event: Any) -> None:
        super().hear(event)
        self.heard()

    def step(self, *events: Any) -> None:
        """Hear events now, and step."""
        for event in events:
            self.hear(replace(event, at=clock.seconds()))
        self.loop.turn()
        self.due = self.plant.next_deadline  # the thread of a plant that runs sleeps until then


class Port:
    """A port that keeps the commands that leave; `sent` is called after each."""

    sent: Callable[[], object] = staticmethod(lambda: None)

    def __init__(self) -> None:
        self.commands: list[Command] = []

    def send(self, message: object) -> None:
        if isinstance(message, Command):
            self.commands.append(message)
            self.sent()


class Logged:
    """An application in which everybody is logged in as an operator."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await self._app({**scope, "arboleda.role": Role.OPERATOR}, receive, send)


async def _ask_by_http(client: httpx.AsyncClient, plant: WholePlant, port: Port) -> None:
    """Send the request to the plant from a thread of its own; the calls of that thread do not count."""
    loop, asked = asyncio.get_running_loop(), asyncio.Event()
    plant.heard = lambda: loop.call_soon_threadsafe(asked.set)
    async with client:
        answer = asyncio.ensure_future(client.post("/api/tasks", json={"text": TEXT}))
        await asked.wait()
        plant.loop.turn()
        assert (await answer).status_code == 202 and port.commands


def _crash(name: str, error: BaseException) -> None:
    raise error


def judged_seeds() -> Iterator[Act]:
    """Simulated seeds with normal faults and every invariant."""
    setting = Request(cycles=CYCLES).setting
    for seed in range(1, SEEDS + 1):
        yield partial(setting.run, seed)


def bare_seeds() -> Iterator[Act]:
    """The same plants and customers without faults and without a judge."""
    setting = Request(cycles=CYCLES).setting
    for seed in range(1, SEEDS + 1):
        yield partial(_bare, setting.plant(seed), seed)


def _bare(model: PlantModel, seed: int) -> None:
    world = World(model)
    customers = Customers(world, seed)
    Attendant(world, seed)
    while customers.cycles < CYCLES:
        world.advance(MINUTE_S)


def _reports(cells: int, by_rad: float) -> Iterator[Act]:
    yard = Yard(_model(cells))
    move = until_a_move(yard)
    for _ in range(TIMES):
        first, *others = yard.words[move.robot].q or ()
        report = yard.say(replace(yard.words[move.robot], q=(first + by_rad, *others)))
        yield partial(yard.plant.step, report.at, (report,))


def _model(cells: int, **timing: float) -> PlantModel:
    with tempfile.TemporaryDirectory() as folder:
        return load(plants.write(Path(folder) / "plant.yaml", cells, timing=timing))


SCENARIOS: dict[str, Scenario] = {
    "step: a report that repeats the last": partial(repeated_reports, 1),
    "step: a report that repeats the last, 100 cells": partial(repeated_reports, 100),
    "step: a report of a moving arm": partial(moving_reports, 1),
    "step: the report that ends a move": partial(ends_of_moves, 1),
    "step: the report that ends a move, 100 cells": partial(ends_of_moves, 100),
    "from a report that ends a command to the next command": from_reports,
    "step: a stop of all cells": partial(stops, 1),
    "step: a stop of all cells, 100 of them": partial(stops, 100),
    "waking of a tree that waits on": waking,
    "a plant from its making to its first command": first_task,
    "a task from HTTP to its first command": from_http,
    "view with one changed cell": partial(views, 1),
    "view with one changed cell of 100": partial(views, 100),
    "view with one changed cell of 300": partial(views, 300),
    "recorded step": recorded_steps,
    f"{SEEDS} simulated seeds, judged": judged_seeds,
    f"{SEEDS} simulated seeds, not judged": bare_seeds,
}
