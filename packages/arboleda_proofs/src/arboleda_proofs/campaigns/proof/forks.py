"""Forks: each fault, or group, in a fork of the process that has simulated what comes before it.

A walk simulates that once for many instants. Where it took less than a fork takes, each run begins anew in
this process instead.
"""

from __future__ import annotations

import os
import pickle
import time
from collections.abc import Callable, Sequence
from functools import cached_property, partial
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.host import abilities
from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.judged_world import BrokenInvariant

from .calm import Calm
from .course import Course, rejoin
from .outcome import Run
from .spent import Spent
from .stage import Stage

Tick = Callable[[], None]
Faults = tuple[Fault, ...]  # of one run
CAN_FORK = abilities.FORKS
FORK_TAKES_S = 0.02  # of a processor: it copies what either process changes, and takes all of that down


class Walk:
    """Walk along a calm run, from instant to instant: at each of them runs with faults fork from it.

    With the `course` of the calm run each ends as soon as it is known how it goes on.
    """

    def __init__(self, model: PlantModel, calm: Calm, course: Course | None = None) -> None:
        self._model, self._calm, self._course = model, calm, course
        self._at = self._took_s = 0.0
        self._spent = Spent()

    @cached_property
    def _stage(self) -> Stage:
        return _stage(self._model, self._calm, self._course)

    def reaches(self, at: float) -> bool:
        """True if `at` s is still to come."""
        return at >= self._at

    def spent(self) -> Spent:
        """The cost since this was asked before."""
        spent, self._spent = self._spent, Spent()
        return spent

    def runs(self, groups: Sequence[Faults], tick: Tick, *, forks: bool | None = None) -> list[Run]:
        """A run for each group of faults, of which the first ones all begin at one instant, which is reached
        or still to come; the same with `forks` and without, by default with them where that is cheaper.
        """
        if not groups or not (CAN_FORK if forks is None else forks):
            return self._anew(groups, tick)
        self._go_to(groups[0][0].at)
        if not forks and self._took_s < FORK_TAKES_S:
            return self._anew(groups, tick)
        runs = []
        for faults in groups:
            began = time.process_time()
            run, steps_s, copies_s = _forked(partial(run_on, self._stage, self._calm, *faults))
            forks_s = copies_s + time.process_time() - began
            self._spent.count(run, faults[0].at, steps_s=steps_s, forks_s=forks_s)
            runs.append(run)
            tick()
        return runs

    def _go_to(self, at: float) -> None:
        began = time.process_time()
        try:
            self._stage.go_to(at)
        except BrokenInvariant as broken:
            raise ArboledaError(f"the run without a fault ended before {at:g} s") from broken
        took_s = time.process_time() - began
        self._at, self._took_s = at, self._took_s + took_s
        self._spent.walks_s += took_s

    def _anew(self, groups: Sequence[Faults], tick: Tick) -> list[Run]:
        runs = []
        for faults in groups:
            began = time.process_time()
            run = run_one(self._model, self._calm, *faults, course=self._course)
            self._spent.count(run, faults[0].at, steps_s=time.process_time() - began)
            runs.append(run)
            tick()
        return runs


def run_all(
    model: PlantModel,
    calm: Calm,
    faults: Sequence[Fault],
    tick: Tick,
    *,
    forks: bool | None = None,
    course: Course | None = None,
) -> list[Run]:
    """A run for each of the faults, which all begin at one instant."""
    return Walk(model, calm, course).runs([(fault,) for fault in faults], tick, forks=forks)


def run_one(model: PlantModel, calm: Calm, *faults: Fault, course: Course | None = None) -> Run:
    """One run from its beginning; without a `course` to its end, whatever is known of that."""
    return run_on(_stage(model, calm, course), calm, *faults)


def run_on(stage: Stage, calm: Calm, *faults: Fault) -> Run:
    """One run, on a stage on which nothing has begun."""
    at = faults[0].at
    return stage.play(
        at,
        lambda: stage.befall(faults),
        expected=calm.state,
        commands=calm.commands,
        lasts_s=calm.lasts_s,
    )


def _stage(model: PlantModel, calm: Calm, course: Course | None) -> Stage:
    stage = Stage(model, calm.scenario, waits=course is None)
    if course is not None:
        rejoin(stage, course)
    return stage


def _forked(play: Callable[[], Run]) -> tuple[Run, float, float]:
    """The run that a fork of this process plays, which is awaited; and the seconds of a processor that the
    fork took in its own code, and in the system's, which copies for it what it changes.
    """
    read, write = os.pipe()
    child = os.fork()
    if not child:
        try:
            os.close(read)
            with os.fdopen(write, "wb") as pipe:
                pickle.dump(play(), pipe)
            os._exit(0)
        finally:  # without a word
            os._exit(1)
    os.close(write)
    with os.fdopen(read, "rb") as pipe:
        data = pipe.read()
    _, _, used = os.wait4(child, 0)
    if not data:
        raise ArboledaError("a run was killed; fewer --jobs need less memory")
    run: Any = pickle.loads(data)
    assert isinstance(run, Run)
    return run, used.ru_utime, used.ru_stime
