"""Forks: each fault of an instant in a fork of the one process that has simulated what comes before it."""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable, Sequence
from typing import Any

from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import PlantModel
from arboleda.simulator.faults import Fault
from arboleda.simulator.judged_world import JudgedWorld

from .calm import Calm
from .outcome import Run
from .stage import AllForked, Stage

Tick = Callable[[], None]
CAN_FORK = hasattr(os, "fork")


def run_all(
    model: PlantModel, calm: Calm, faults: Sequence[Fault], tick: Tick, *, forks: bool = CAN_FORK
) -> list[Run]:
    """A run for each of the faults, which all begin at one instant; the same with forks and without."""
    if forks and faults:
        return _forked(model, calm, faults, tick)
    runs = []
    for fault in faults:
        runs.append(run_one(model, calm, fault)[0])
        tick()
    return runs


def run_one(model: PlantModel, calm: Calm, fault: Fault, *, keep: bool = False) -> tuple[Run, Stage]:
    """One run from its beginning, and its stage; `keep`: with its timeline."""
    stage = Stage(model, calm.scenario, keep=keep)
    return _play(stage, calm, fault, lambda: stage.watched.begin(fault)), stage


def _play(stage: Stage, calm: Calm, fault: Fault, begin: Callable[[], None]) -> Run:
    return stage.play(fault.at, begin, expected=calm.state, commands=calm.commands, lasts_s=calm.lasts_s)


def _forked(model: PlantModel, calm: Calm, faults: Sequence[Fault], tick: Tick) -> list[Run]:
    stage = Stage(model, calm.scenario)
    forks = _Forks(stage.watched, faults, tick)
    try:
        run = _play(stage, calm, faults[0], forks.begin)
        forks.answer(run)
    except AllForked:
        return forks.runs
    finally:
        forks.leave()
    raise ArboledaError(f"the run without a fault ended before {faults[0].at:g} s")


class _Forks:
    """Forks at the instant: this process waits for each, in which one fault begins and the run goes on."""

    def __init__(self, watched: JudgedWorld, faults: Sequence[Fault], tick: Tick) -> None:
        self.runs: list[Run] = []
        self._watched, self._faults, self._tick = watched, faults, tick
        self._pipe: int | None = None  # in a fork: where its run is awaited

    def begin(self) -> None:
        """Fork for each fault; returns in the forks only."""
        for fault in self._faults:
            read, write = os.pipe()
            child = os.fork()
            if not child:
                os.close(read)
                self._pipe = write
                self._watched.begin(fault)
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
        said = pipe.read()
    os.waitpid(child, 0)
    if not said:
        raise ArboledaError("a run was killed; fewer --jobs need less memory")
    run: Any = pickle.loads(said)
    assert isinstance(run, Run)
    return run
