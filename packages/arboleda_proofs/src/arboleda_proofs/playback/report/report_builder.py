"""Maker of the report of a task: why it failed, and what packages wrote about it."""

from __future__ import annotations

import shlex
from collections.abc import Callable

from arboleda_proofs.playback.cause import Cause

from .case import case_of
from .page import Report, page
from .reading import TaskRecord
from .tries import tries


def made(read: TaskRecord, tell: Callable[[int], None] = lambda _: None) -> tuple[Cause | None, str]:
    """The cause of the failure, if there is one, and the content of the file; `tell` is told the number of
    each fork."""
    found, beginning = read.incident, read.record.first.beginning
    cause = found.cause if found.failure is not None else None
    plant_file = "" if beginning.shipped else beginning.files.plant
    path = shlex.quote(str(read.record.paths[0]))
    report = Report(
        incident=found,
        cause=cause,
        model=read.model,
        tries=tries(read, tell) if cause is not None else [],
        case="" if cause is None else case_of(found, cause, read.model, plant_file),
        command=f"arboleda record replay {path} --task {shlex.quote(found.task)}",
    )
    return cause, page(report)
