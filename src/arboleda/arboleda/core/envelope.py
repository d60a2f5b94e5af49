"""Envelope of running tasks: the effectors that may have switched without this being durable."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from arboleda.dispatch.fact_memory import Memory
from arboleda.model.grips import Grip
from arboleda.model.messages import Fact, KeptTask, Remember, TaskState
from arboleda.resume.trail import Trail

from .cell import CellRun


def unsettled(memory: Memory, kept: Iterable[KeptTask]) -> Iterator[Remember]:
    """The changes of what is kept after a power cut, which may have undone the last of it.

    An effector of a running task's envelope counts as switching until its device reports what it holds.
    """
    grips = memory.get(Fact.EFFECTOR, {})
    for task in kept:
        if task.state is TaskState.RUNNING:
            for name in _envelope(memory.get(Fact.STEP, {}).get(task.id)):
                if grips.get(name) != Grip.SWITCHING.value:
                    yield Remember(fact=Fact.EFFECTOR, name=name, value=Grip.SWITCHING.value)


def of_task(run: CellRun) -> Iterable[str]:
    """The effectors that the task of a cell may tell to switch before this is durable."""
    return run.keeping.envelope if run.task is not None and run.task.ended_at is None else ()


def _envelope(trail: str | None) -> Iterable[str]:
    """The envelope of a task, of which every trail has it; none where another version wrote that."""
    try:
        return () if trail is None else Trail.read(trail).begun.envelope
    except ValueError:
        return ()
