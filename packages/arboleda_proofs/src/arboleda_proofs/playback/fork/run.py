"""Run of a fork: the record up to a time, then the same plant on virtual devices."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import chain
from typing import Any

from arboleda.drivers import Evidence
from arboleda.engine import Plant
from arboleda.extension import ConfigError
from arboleda.model.cell_states import CellState
from arboleda.model.messages import ENDED, Event
from arboleda.model.plant_model import Link, PlantModel
from arboleda.model.recipe import Builders
from arboleda.model.revision import Versions
from arboleda.recorder import plain_data
from arboleda.recorder.preamble import Beginning
from arboleda.recorder.record_text import moment
from arboleda.recorder.state import state_of
from arboleda.recorder.steps import RecordedStep, hash_of, outcome
from arboleda.rig.world import World
from arboleda_proofs.campaigns.plants import ELSEWHERE
from arboleda_proofs.playback.replay import ReplayedStep, first_difference
from arboleda_proofs.playback.troubles import Trouble, Troubles
from arboleda_proofs.simulator.takeover import taken_over

from . import device_replay
from .builders import LateLookup
from .plant_events import TASK, PlantEvent, Words, happenings

AFTER_S = 600.0  # for tasks to end after the end of the record
ENDS = frozenset(each.value for each in ENDED)


@dataclass(frozen=True, kw_only=True)
class ForkRequest:
    """The wanted fork: its time (Unix time in ns), and its plant.

    `model` is the plant of the fork: the `recorded` one, or a changed one, which gets the recorded inputs
    from the beginning. `builders` make the trees of tasks that begin after the fork. `healthy`: recorded
    troubles after it are not repeated on the virtual devices. `until_ns`: later parts of the record are left
    out. `versions` are those that it took while it ran, or what stands in for them. With a `task` the fork
    ends as soon as that has ended. `known`: an earlier fork has compared the steps up to it.
    """

    at_ns: int
    model: PlantModel
    recorded: PlantModel
    builders: Builders | None = None
    healthy: bool = False
    until_ns: int | None = None
    versions: Versions = field(default_factory=dict)
    task: str = ""
    known: bool = False

    @property
    def changed(self) -> bool:
        return self.model is not self.recorded


@dataclass
class ForkResult:
    """The result of a fork. `difference`: the record cannot be executed up to the fork; there is none."""

    at: float = 0.0  # on the plant's clock
    unix_ns: int = 0
    steps: int = 0  # executed before it
    early: bool = False  # the changed plant differed before the wanted time
    difference: ReplayedStep | None = None
    until: float = 0.0  # the last step of the record
    recorded: list[PlantEvent] = field(default_factory=list)
    fork: list[PlantEvent] = field(default_factory=list)
    troubles: list[Trouble] = field(default_factory=list)
    world: World | None = None


def forked(
    beginning: Beginning, steps: Iterable[RecordedStep], request: ForkRequest, words: Words
) -> ForkResult:
    """Execute the record up to the fork, go on from there, and collect the happenings of both since."""
    found, builders = ForkResult(), LateLookup()
    plant = Plant(
        request.model,
        epoch=beginning.epoch,
        now=beginning.now,
        memory=beginning.memory,
        kept=beginning.kept,
        recipes=builders,
        versions=request.versions,
    )
    troubles = Troubles(_supervised(request.recorded), request.recorded.timing.stale_after_s)
    rest = iter(steps)
    parted = _execute(plant, rest, request, found, troubles)
    if found.difference is not None:
        return found
    if parted[0] is None and not request.changed:
        when = moment(found.unix_ns, "milliseconds")
        raise ConfigError((f"a fork after the last step of the record, of {when}, has nothing after it",))
    builders.switch(request.builders)
    first, *others = parted
    inputs: list[tuple[float, tuple[Event, ...]]] = []
    if found.early and first is not None:
        found.fork += happenings(first.now, _plain(others), words)
        found.recorded += happenings(first.now, first.result["messages"], words)
    elif first is not None:
        rest = chain([first], rest)
    for step in _until(rest, request.until_ns):
        troubles.take(step.events)
        inputs.append((step.now, step.events))
        found.recorded += happenings(step.now, step.result["messages"], words)
        found.until = step.now
    found.troubles = [each for each in troubles.of(found.until) if each.ends > found.at]
    found.world = _go_on(plant, found, inputs, request, words)
    return found


def _supervised(model: PlantModel) -> frozenset[str]:
    """The robots whose silence is a trouble, by name."""
    robots = model.robots.values()
    silent = (Link.SCREEN, Link.NONE)
    return frozenset(
        each.name for each in robots if each.evidence is not Evidence.STATE and each.link not in silent
    )


def _execute(
    plant: Plant, steps: Iterator[RecordedStep], request: ForkRequest, found: ForkResult, troubles: Troubles
) -> list[Any]:
    """Execute steps up to the fork. Returns the first step after it; if the fork is early, the step in which
    the plant did otherwise, with its messages."""
    found.at = found.until = plant.now
    for step in _until(steps, request.until_ns):
        if step.unix_ns > request.at_ns:
            if not found.steps:  # it goes on from the plant's beginning
                found.unix_ns = step.unix_ns - round((step.now - plant.now) * 1e9)
            return [step]
        found.steps, found.at, found.unix_ns = found.steps + 1, step.now, step.unix_ns
        found.until = step.now
        troubles.take(step.events)
        messages = plant.step(step.now, step.events)
        if request.changed:
            if _leaves(_plain(messages)) != _leaves(step.result["messages"]):
                found.early = True
                return [step, *messages]
            continue
        if request.known:
            continue
        result = outcome(messages, state_of(plant, found.steps))
        if hash_of(result) != step.hash:
            found.difference = ReplayedStep(found.steps, step, first_difference(step.result, result))
            return [step]
    return [None]


def _plain(messages: Iterable[Any]) -> list[dict[str, Any]]:
    return [plain_data.plain(each) for each in messages]


def _leaves(messages: Iterable[dict[str, Any]]) -> list[tuple[str, str]]:
    """The messages that others see; the plant's own memory and its beat may differ between runs."""
    return [(each.stream, each.what) for each in happenings(0.0, messages, lambda _: "")]


def _until(steps: Iterable[RecordedStep], until_ns: int | None) -> Iterator[RecordedStep]:
    for step in steps:
        if until_ns is not None and step.unix_ns > until_ns:
            return
        yield step


def _go_on(
    plant: Plant,
    found: ForkResult,
    inputs: Iterable[tuple[float, tuple[Event, ...]]],
    request: ForkRequest,
    words: Words,
) -> World:
    model = plant.model if request.versions else request.model
    world = taken_over(plant, model.on_boards(*ELSEWHERE))
    for now, events in inputs:
        device_replay.ask(world, now, events)
    if not request.healthy:
        device_replay.befall(world, found.troubles)
    ends = [each for each in found.fork if _ends(each, request.task)]

    def watch() -> None:
        news = [*happenings(world.now, _plain(world.moment.sent), words)]
        found.fork.extend(news)
        ends.extend(each for each in news if _ends(each, request.task))

    world.watchers.append(watch)
    world.advance(found.until - world.now, lambda: bool(ends))
    world.advance(AFTER_S, lambda: bool(ends) or _rests(plant))
    return world


def _ends(happened: PlantEvent, task: str) -> bool:
    return happened.stream == TASK + task and happened.what.partition(" ")[0] in ENDS


def _rests(plant: Plant) -> bool:
    return all(run.state is not CellState.EXECUTE for run in plant.cells.values())
