"""Flight records of one seed: one for each start of its plant, in files beside each other."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

from arboleda.extension import ArboledaError
from arboleda.model.counting import counted
from arboleda.model.recording import Limits
from arboleda.recorder import copying, files, reader
from arboleda.rig.world import START_S

from .plants import Plant
from .setting import MakePlant
from .simulated_recorder import SECOND, RecordNotWritten, SimulatedRecorder

SUFFIX = ".mcap"
NOON_NS = 946_728_000 * SECOND  # 2000-01-01 12:00 UTC: a seed's record has the same times always
ALL = Limits(megabytes=1e6, days=1e6)


@dataclass
class Flight:
    """The recording of a seed: `make_plant` for the world; at the end `lines` has a line for each file."""

    make_plant: MakePlant
    lines: list[str] = field(default_factory=list)


@contextmanager
def recorded(file: Path, plant: Plant) -> Iterator[Flight]:
    """Record the first start of a plant in `file`, later ones in files beside it; ArboledaError."""
    with TemporaryDirectory(prefix=".arboleda-", dir=file.parent) as made:
        recorder = SimulatedRecorder(Path(made), plant.files, ALL, NOON_NS - round(START_S * SECOND))
        flight = Flight(recorder.plant)
        try:
            yield flight
            recorder.close()
        except RecordNotWritten as lost:
            raise ArboledaError(f"{file}: cannot be written: {lost.error.strerror or lost.error}") from lost
        flight.lines += _copied(Path(made), file)


def _copied(made: Path, file: Path) -> Iterator[str]:
    firsts = [part.path for part in files.parts_in(made) if part.number == 1]
    for number, first in enumerate(firsts, start=1):
        record = reader.opened(first)
        target = file if number == 1 else file.with_name(f"{file.stem}-{number}{SUFFIX}")
        steps = copying.as_mcap(record, target, record.numbers)
        of = f", of start {number} of {len(firsts)}" if len(firsts) > 1 else ""
        yield f"{target} has {counted(steps, 'step')}{of}"
