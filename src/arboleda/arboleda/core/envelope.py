"""Envelope of a running task: the effectors that it may tell to switch before their new grip is durable."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from arboleda.dispatch.fact_memory import Memory
from arboleda.model.grips import Grip
from arboleda.model.messages import Fact, KeptTask, Remember, TaskState
from arboleda.resume.trail import Trail

from .cell import CellRun


def unsettled(memory: Memory, tasks: Iterable[KeptTask]) -> Iterator[Remember]:
    """The facts to change after a power cut, which may have undone the last writes.

    The command that switched an effector of an envelope may have left, and its grip be lost. So each of them
    counts as switching until its device reports whether it holds anything.
    """
    grips = memory.get(Fact.EFFECTOR, {})
    for task in tasks:
        if task.state is TaskState.RUNNING:
            for name in _envelope(memory.get(Fact.STEP, {}).get(task.id)):
                if grips.get(name) != Grip.SWITCHING.value:
                    yield Remember(fact=Fact.EFFECTOR, name=name, value=Grip.SWITCHING.value)


def of_task(run: CellRun) -> Iterable[str]:
    """The envelope of a cell's task; empty without a task."""
    return run.keeping.envelope if run.task is not None and run.task.ended_at is None else ()


def _envelope(trail: str | None) -> Iterable[str]:
    """The envelope in a trail; empty where another version of Arboleda wrote the trail."""
    try:
        return () if trail is None else Trail.read(trail).begun.envelope
    except ValueError:
        return ()
