"""`arboleda report`: the cause of a task's failure, as one file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from arboleda.model.errors import ConfigError
from arboleda.model.outside import plain
from arboleda.recorder.errors import NoRecord

from .plant_options import PlantFile, StateFolder, folder

LONGEST = 300  # characters of a line
WHAT = "Write why a task failed: one HTML file, without network, in English and Spanish."
HOW = (
    "The record of the plant is executed again, and forks of it are run: report only on records that you "
    "trust. The plant may run meanwhile."
)
EXIT = "Exit status: 0 written, 2 no such task, one that has not failed, or no record that can be replayed."


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
    from arboleda.playback.report.reading import read
    from arboleda.playback.report.report_builder import made
    from arboleda.recorder.files import FOLDER

    where = folder(plant, state) / FOLDER if record is None else record.parent
    found = read(task, record, where)
    if found.record.missing:
        raise NoRecord(f"{found.record.paths[0]} cannot be replayed: its first files were deleted.")
    if found.incident.failure is None:
        state_now = found.incident.state.value if found.incident.state else "unknown"
        raise ConfigError((f"{plain(task, 80)}: it is {state_now}, so there is nothing to report",))
    target = output or Path(f"{plain(task, 80).replace('/', '_')}.html")
    cause, content = made(found)
    try:
        target.write_text(content, "utf-8")
    except OSError as error:
        raise ConfigError((f"{target}: cannot be written: {error.strerror}",)) from error
    print(plain(str(cause.sentence), LONGEST))
    print(plain(f"{target} has {len(content.encode()) / 1e3:.0f} kB", LONGEST))
