"""Export of a record as a case for `arboleda simulate`, which `arboleda record export` asks for."""

from __future__ import annotations

from pathlib import Path

from arboleda.cli.record import LONGEST
from arboleda.drivers import plain
from arboleda.extension import Phrase, Sentence, say
from arboleda.plant_file.user_file import check_new
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.reader import Record

from ..playback.case import writing
from ..playback.case.reading import case_of

NOT_REPLAYED = Phrase(
    "cli.record.not_replayed",
    "{file} cannot be replayed, only read: its first {number} files were deleted to make room.",
)
CASE = Phrase("cli.record.case", "{file} has {tasks}, {acts}, {faults} in {seconds} s")
COUNTS = {  # of one, and of more or none
    "tasks": (Phrase("cli.record.task", "{number} task"), Phrase("cli.record.tasks_of", "{number} tasks")),
    "acts": (
        Phrase("cli.record.act", "{number} act of operators"),
        Phrase("cli.record.acts", "{number} acts of operators"),
    ),
    "faults": (Phrase("cli.record.fault", "{number} fault"), Phrase("cli.record.faults", "{number} faults")),
}


def export(record: Record, task: str | None, output: Path) -> None:
    """Write a case, of one task or of a whole record, and say what is in it."""
    check_new(output)
    if record.missing:
        raise NoRecord(say(NOT_REPLAYED(file=str(record.paths[0]), number=record.missing)))
    case = case_of(record, task)
    writing.write(output, writing.as_yaml(case, record.first.beginning, output.name))
    tasks = sum(act.task is not None for act in case.people)
    acts = len(case.people) - tasks
    made = _counted("tasks", tasks), _counted("acts", acts), _counted("faults", len(case.faults))
    line = CASE(file=str(output), seconds=f"{case.seconds:.1f}", tasks=made[0], acts=made[1], faults=made[2])
    print(plain(say(line), LONGEST))


def _counted(of: str, number: int) -> Sentence:
    one, more = COUNTS[of]
    return (one if number == 1 else more)(number=number)
