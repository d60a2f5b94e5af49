"""Forks: each fault, or group, of an instant in a fork of the process that simulated what comes before it.

Where that took less than a fork takes, each run begins anew in this process instead.
"""

from __future__ import annotations

import os
import pickle
import time
from collections.abc import Callable, Sequence
from typing import Any

from arboleda.host import abilities
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.faults import Fault

from .calm import Calm
from .course import Course, rejoin
from .outcome import Run
from .stage import AllForked, Stage

Tick = Callable[[], None]
Faults = tuple[Fault, ...]  # of one run
CAN_FORK = abilities.FORKS
FORK_TAKES_S = 0.02  # of a processor: it copies what either process changes, and takes all of that down


def run_all(
    model: PlantModel,
    calm: Calm,
    faults: Sequence[Fault],
    tick: Tick,
    *,
    forks: bool | None = None,
    course: Course | None = None,
) -> list[Run]:
    """A run for each of the faults, which all begin at one instant; the same with `forks` and without, by
    default with them where that is cheaper.

    With the `course` of the calm run each ends as soon as it is known how it goes on.
    """
    return run_groups(model, calm, [(fault,) for fault in faults], tick, forks=forks, course=course)


def run_groups(
    model: PlantModel,
    calm: Calm,
    groups: Sequence[Faults],
    tick: Tick,
    *,
    forks: bool | None = None,
    course: Course | None = None,
) -> list[Run]:
    """The same for groups of faults that befall one run: their first ones all begin at one instant."""
    if groups and (CAN_FORK if forks is None else forks):
        return _forked(model, calm, groups, tick, course, 0.0 if forks else FORK_TAKES_S)
    return _anew(model, calm, groups, tick, course)


def _anew(
    model: PlantModel, calm: Calm, groups: Sequence[Faults], tick: Tick, course: Course | None
) -> list[Run]:
    runs = []
    for faults in groups:
        runs.append(run_one(model, calm, *faults, course=course))
        tick()
    return runs


def run_one(model: PlantModel, calm: Calm, *faults: Fault, course: Course | None = None) -> Run:
    """One run from its beginning; without a `course` to its end, whatever is known of that."""
    return run_on(_stage(model, calm, course), calm, *faults)


def _stage(model: PlantModel, calm: Calm, course: Course | None) -> Stage:
    stage = Stage(model, calm.scenario, waits=course is None)
    if course is not None:
        rejoin(stage, course)
    return stage


def run_on(stage: Stage, calm: Calm, *faults: Fault) -> Run:
    """One run from its beginning, on a stage on which nothing has happened."""
    return _play(stage, calm, faults, lambda: stage.befall(faults))


def _play(stage: Stage, calm: Calm, faults: Faults, begin: Callable[[], None]) -> Run:
    at = faults[0].at
    return stage.play(at, begin, expected=calm.state, commands=calm.commands, lasts_s=calm.lasts_s)


def _forked(
    model: PlantModel,
    calm: Calm,
    groups: Sequence[Faults],
    tick: Tick,
    course: Course | None,
    cheap_s: float,
) -> list[Run]:
    """Runs in forks; if it took less than `cheap_s` to come to the instant, in this process."""
    cheap_until = time.process_time() + cheap_s
    stage = _stage(model, calm, course)
    forks = _Forks(stage, groups, tick, cheap_until)
    try:
        run = _play(stage, calm, groups[0], forks.begin)
        forks.answer(run)
    except AllForked:
        return forks.runs
    finally:
        forks.leave()
    if not forks.begun:
        raise ArboledaError(f"the run without a fault ended before {groups[0][0].at:g} s")
    tick()
    return [run, *_anew(model, calm, groups[1:], tick, course)]


class _Forks:
    """Forks at the instant: this process waits for each, in which one fault begins and the run goes on.

    At an instant that came before `cheap_until`, by the processor time of this process, it forks nothing, and
    goes on with the first group itself.
    """

    def __init__(self, stage: Stage, groups: Sequence[Faults], tick: Tick, cheap_until: float) -> None:
        self.runs: list[Run] = []
        self.begun = False
        self._stage, self._groups, self._tick = stage, groups, tick
        self._cheap_until = cheap_until
        self._pipe: int | None = None  # in a fork: where its run is awaited

    def begin(self) -> None:
        """Fork for each group; returns in the forks only, or if there are none."""
        self.begun = True
        if time.process_time() < self._cheap_until:
            self._stage.befall(self._groups[0])
            return
        for faults in self._groups:
            read, write = os.pipe()
            child = os.fork()
            if not child:
                os.close(read)
                self._pipe = write
                self._stage.befall(faults)
                return
            os.close(write)
            self.runs.append(_awaited(read, child))
            self._tick()
        raise AllForked

    def answer(self, run: Run) -> None:
        """In a fork: hand over the run, and end."""
        if self._pipe is not None:
            with os.fdopen(self._pipe, "wb") as pipe:
                pickle.dump(run, pipe)
            os._exit(0)

    def leave(self) -> None:
        """In a fork that has not answered: end without a word."""
        if self._pipe is not None:
            os._exit(1)


def _awaited(read: int, child: int) -> Run:
    with os.fdopen(read, "rb") as pipe:
        data = pipe.read()
    os.waitpid(child, 0)
    if not data:
        raise ArboledaError("a run was killed; fewer --jobs need less memory")
    run: Any = pickle.loads(data)
    assert isinstance(run, Run)
    return run
