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

    The command that switched an effector of an envelope may have left, and its grip be lost. So none of them
    counts as off until its device reports whether it holds anything.
    """
    grips = memory.get(Fact.EFFECTOR, {})
    for task in tasks:
        trail = _read(memory.get(Fact.STEP, {}).get(task.id)) if task.state is TaskState.RUNNING else None
        if trail is None:
            continue
        for name in trail.begun.envelope:
            may_be = _after(trail.grips.get(name) or grips.get(name)).value
            if grips.get(name) != may_be:
                yield Remember(fact=Fact.EFFECTOR, name=name, value=may_be)


def _after(kept: str | None) -> Grip:
    """The grip that an effector may have after the writes that are lost.

    One that was off may have been told to take a part, but not also to put it down elsewhere: no command to
    move leaves before the write of its grip is durable.
    """
    return Grip.ON if kept in (None, Grip.OFF.value) else Grip.SWITCHING


def of_task(run: CellRun) -> Iterable[str]:
    """The envelope of a cell's task; empty without a task."""
    return run.keeping.envelope if run.task is not None and run.task.ended_at is None else ()


def _read(trail: str | None) -> Trail | None:
    """The trail in a text; None where another version of Arboleda wrote it."""
    try:
        return None if trail is None else Trail.read(trail)
    except ValueError:
        return None
