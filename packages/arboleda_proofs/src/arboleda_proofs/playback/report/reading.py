"""Reader of a task: finds it in the records of a plant."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from arboleda.drivers import plain
from arboleda.extension import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.recorder import files, reader
from arboleda.recorder.reader import Record
from arboleda.recorder.steps import RecordedStep
from arboleda.recorder.writing import FLUSH_S
from arboleda_proofs.playback.incident import Incident, Reader
from arboleda_proofs.playback.replay import plant_of

from ..recorded_plant import model_of, versions_of

LOOK_S = 0.5  # between two looks at a record that is being written
TOLD_STEPS = 200  # between two words on how far it is
MOST_KEPT = 10_000  # steps, of some kB each, that are read once and not for each fork


@dataclass(frozen=True, kw_only=True)
class TaskRecord:
    """A record, its plant, and its incident of the task; `read` are the steps up to its end, if few."""

    record: Record
    model: PlantModel
    incident: Incident
    read: Sequence[RecordedStep] = ()

    def steps(self) -> Iterable[RecordedStep]:
        """The steps of the record, as far as the incident reaches."""
        return self.read or self.record.steps()


def read(
    task: str, record: Path | None, folder: Path, tell: Callable[[float], None] = lambda _: None
) -> TaskRecord:
    """The task in this record, or in the newest of a folder that has it; ConfigError where none has.

    Parts of the record that a running plant has not written yet are waited for, some seconds. `tell` is
    told the share of the record that was executed again.
    """
    until = time.monotonic() + FLUSH_S + 2.0
    while True:
        paths = [record] if record is not None else list(_newest(folder))
        found = next((path for path in paths if _has(path, task)), None)
        if found is not None:
            whole = reader.opened(found)
            incident, steps = incident_of(task, whole, tell)
            if incident.ended_at is not None or time.monotonic() > until:
                model = model_of(whole.first.beginning)
                incident.take_chapters(whole, later=record is None)
                return TaskRecord(record=whole, model=model, incident=incident, read=steps)
        elif time.monotonic() > until or not paths or not _is_written(paths[0]):
            raise ConfigError((f"{plain(task, 80)}: no record of this plant has such a task",))
        time.sleep(LOOK_S)


def _newest(folder: Path) -> Iterator[Path]:
    """A file of each record, the newest first."""
    epochs: set[int] = set()
    for part in reversed(files.parts_in(folder)):
        if part.epoch not in epochs:
            epochs.add(part.epoch)
            yield part.path


def _has(path: Path, task: str) -> bool:
    """True if a record names the task, if only in a request."""
    word = f'"task":"{task}"'.encode()
    return any(word in data for _, data in reader.opened(path).raw())


def _is_written(path: Path) -> bool:
    return time.time() - path.stat().st_mtime < 2 * FLUSH_S


def incident_of(
    task: str, record: Record, tell: Callable[[float], None] = lambda _: None
) -> tuple[Incident, Sequence[RecordedStep]]:
    """The incident of a task, from executing the record again up to the task's end, and the steps that were
    read; none of them if they are many.
    """
    beginning = record.first.beginning
    model = model_of(beginning)
    plant, looks = plant_of(beginning, model, versions_of(record)), Reader(task, model)
    there = reader.steps_there(record.paths) or 0
    steps: list[RecordedStep] = []
    number = 0
    for number, step in enumerate(record.steps(), start=1):
        if number <= MOST_KEPT:
            steps.append(step)
        if there and number % TOLD_STEPS == 0:
            tell(min(1.0, number / there))
        looks.take(plant, step.unix_ns, step.now, step.events, plant.step(step.now, step.events))
        if looks.over:
            break
    return looks.incident, steps if number <= MOST_KEPT else ()
