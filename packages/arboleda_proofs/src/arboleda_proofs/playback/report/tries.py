"""Changes that might have saved a task: forks of the record that are really run."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from arboleda.model.plant_model import PlantModel
from arboleda.recorder.record_text import sentence_of
from arboleda_proofs.playback.incident import AFTER_S, Incident
from arboleda_proofs.playback.troubles import SILENCE

from ..fork.plant_events import TASK, PlantEvent
from ..fork.run import ForkRequest, forked
from ..recorded_plant import versions_of
from .reading import TaskRecord

LONGER = 3.0  # times a deadline
EARLIER_NS = 100_000_000  # the fork begins so long before the request of the task
MARGIN_S = 0.5
WITHOUT, HEALTHY, STALE, DEADLINE = "without", "healthy", "stale", "deadline"


@dataclass(frozen=True, kw_only=True)
class ForkTrial:
    """A fork: its change in a word, its value, and the end of the task; `options` run it again.

    `alike`: the task ended in the same state for the same reason as in the record.
    """

    what: str
    value: float
    end: str
    done: bool
    alike: bool
    options: str


def tries(read: TaskRecord, tell: Callable[[int], None] = lambda _: None) -> list[ForkTrial]:
    """The forks of a task from its beginning: without any change first. If that one ends otherwise than the
    record did, other ones would prove nothing, and are not run. `tell` is told the number of each."""
    found: list[ForkTrial] = []
    for number, (what, value, model, options) in enumerate(_changes(read.model, read.incident), start=1):
        tell(number)
        found.append(_tried(read, what, value, model, options))
        if not found[0].alike:
            break
    return found


def _changes(model: PlantModel, incident: Incident) -> Iterator[tuple[str, float, PlantModel, str]]:
    timing = model.timing
    yield WITHOUT, 0.0, model, ""
    yield HEALTHY, 0.0, model, "--healthy"
    trouble = incident.evidence.trouble
    if trouble is not None and trouble.kind == SILENCE and not trouble.cut and trouble.seconds < math.inf:
        longer_s = round(trouble.seconds + MARGIN_S, 1)
        patient = replace(model, timing=replace(timing, stale_after_s=longer_s))
        yield STALE, longer_s, patient, f"--set timing.stale_after_s={longer_s:g}"
    if incident.evidence.reason.value == "deadline":
        factor = timing.deadline_factor * LONGER
        patient = replace(model, timing=replace(timing, deadline_factor=factor))
        yield DEADLINE, factor, patient, f"--set timing.deadline_factor={factor:g}"


def _tried(read: TaskRecord, what: str, value: float, model: PlantModel, options: str) -> ForkTrial:
    incident, record = read.incident, read.record
    since_s = (incident.ended_at or 0.0) - incident.began_at
    versions = {
        digest: replace(each, timing=model.timing) if model is not read.model else each
        for digest, each in versions_of(record).items()
    }
    request = ForkRequest(
        at_ns=incident.unix_ns - round(since_s * 1e9) - EARLIER_NS,
        model=model,
        recorded=read.model,
        healthy=what == HEALTHY,
        until_ns=incident.unix_ns + round(AFTER_S * 1e9),
        versions=versions,
        task=incident.task,
        known=what == HEALTHY,
    )
    found = forked(record.first.beginning, read.steps(), request, sentence_of)
    fork, recorded = (_last(row, incident.task) for row in (found.fork, found.recorded))
    end = fork.text if fork else "?"
    alike = fork is not None and recorded is not None and fork.what == recorded.what
    done = end.startswith("done")
    return ForkTrial(what=what, value=value, end=end, done=done, alike=alike, options=options)


def _last(row: Sequence[PlantEvent], task: str) -> PlantEvent | None:
    """The last change of the task in a run."""
    return next((each for each in reversed(row) if each.stream == TASK + task), None)
