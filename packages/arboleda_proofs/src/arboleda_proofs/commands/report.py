"""`arboleda report`: the cause of a task's failure, as one file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from arboleda.cli.language import word
from arboleda.cli.plant_options import folder
from arboleda.cli.record import HAS_KB
from arboleda.drivers import plain
from arboleda.extension import ConfigError, Phrase, PlantFile, StateFolder, say, working
from arboleda.recorder.errors import NoRecord

LONGEST = 300  # characters of a line
WHAT = "Write why a task failed: one HTML file, without network, in English and Spanish."
HOW = (
    "The record of the plant is executed again, and forks of it are run: report only on records that you "
    "trust. The plant may run meanwhile."
)
EXIT = "Exit status: 0 written, 2 no such task, nothing to report of it, or no record that can be replayed."
GONE = Phrase("cli.report.gone", "{file} cannot be replayed: its first files were deleted.")
NOT_FAILED = Phrase("cli.report.not_failed", "{task}: it is {state}, so there is nothing to report")
NO_STATE = Phrase("cli.report.no_state", "{task}: its state is unknown, so there is nothing to report")
UNWRITTEN = Phrase("cli.report.unwritten", "{file}: cannot be written: {error}")
READING = Phrase("cli.report.reading", "executes the record again: {share}")
TRYING = Phrase("cli.report.trying", "tries what might have saved the task: fork {number}")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command(help=f"{WHAT}\n\n{HOW}\n\n{EXIT}", short_help=WHAT)(report)


def report(
    task: Annotated[str, typer.Argument(metavar="TASK", help="The id of the task.")],
    record: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="A file of its record. [default: the newest that has the task]"),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="The file to make. [default: TASK.html]")
    ] = None,
    plant: PlantFile = None,
    state: StateFolder = None,
) -> None:
    with working() as tell:
        from arboleda.recorder import files
        from arboleda_proofs.playback.report.reading import read
        from arboleda_proofs.playback.report.report_builder import made

        where = folder(plant, state) / files.FOLDER if record is None else record.parent
        found = read(task, record, where, lambda share: tell(say(READING(share=f"{share:.0%}"))))
    if found.record.missing:
        raise NoRecord(say(GONE(file=str(found.record.paths[0]))))
    if found.incident.failure is None and not found.incident.chapters:
        named, state_now = plain(task, 80), found.incident.state
        shown = NOT_FAILED(task=named, state=word("task_state", state_now.value)) if state_now else None
        raise ConfigError((say(shown or NO_STATE(task=named)),))
    target = output or Path(f"{plain(task, 80).replace('/', '_')}.html")
    with working() as tell:
        cause, content = made(found, lambda number: tell(say(TRYING(number=number))))
    try:
        target.write_text(content, "utf-8")
    except OSError as error:
        raise ConfigError((say(UNWRITTEN(file=str(target), error=str(error.strerror))),)) from error
    if cause is not None:
        print(plain(say(cause.sentence), LONGEST))
    size = f"{len(content.encode()) / 1e3:.0f}"
    print(plain(say(HAS_KB(file=str(target), kilobytes=size)), LONGEST))
