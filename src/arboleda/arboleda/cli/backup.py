"""`arboleda backup` and `arboleda restore`: the plant's memory in a file, and back."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from arboleda.model.errors import StartError
from arboleda.model.sentence import Phrase
from arboleda.plant_file import loader
from arboleda.runtime.state import STORE, StateDir, find_running, holder
from arboleda.store import backups

from .language import say
from .plant_options import PlantFile, RunningPlant, StateFolder, folder, located, name_of, store_of

MEMORY = "Tasks, stop latches, what effectors hold, quarantined zones and the operators' journal are in it."
COPY = "Copy the plant's memory to a file, while the plant runs or not."
PUT_BACK = "Put a backup in the place of the plant's memory; the plant must not run."
CAUTION = (
    "What was there is kept beside it. Latches, grips and zones are then those of the time of the "
    "backup: look at the robots before you start the plant."
)
EXIT = "Exit status: 0 done, 1 it could not be, 2 bad input."
COPIED = Phrase("cli.backup.copied", "{memory} is copied to {file}")
END_FIRST = Phrase("cli.backup.end_first", "{held} End it first.")
RESTORED = Phrase("cli.backup.restored", "{memory} is now {file}; what was there is {memory}.before-restore")
IN_DATABASE = Phrase(
    "cli.backup.in_database",
    "This plant's memory is in {store}: `pg_dump --schema 'plant_*'` copies it while the plant runs, "
    "pg_restore puts it back; see docs/how-to/two-hosts.md.",
)


def add_to(cli: typer.Typer) -> None:
    """Add the commands."""
    cli.command(help=f"{COPY}\n\n{MEMORY}\n\n{EXIT}", short_help=COPY)(backup)
    cli.command(help=f"{PUT_BACK}\n\n{CAUTION}\n\n{EXIT}", short_help=PUT_BACK)(restore)


def backup(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The file to make.")],
    plant: RunningPlant = None,
    state: StateFolder = None,
) -> None:
    where = located(plant, state)
    _refuse_database(plant, where)
    memory = where / STORE
    backups.back_up(memory, file, name_of(plant))
    print(say(COPIED(memory=str(memory), file=str(file))))


def restore(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="What `arboleda backup` made.")],
    plant: PlantFile = None,
    state: StateFolder = None,
) -> None:
    where = folder(plant, state)
    _refuse_database(plant, where)
    if find_running(where) is not None:
        raise StartError(END_FIRST(held=holder(where)))
    name = loader.load(plant, recipes=False).name if plant or not state else ""
    with backups.opened(file) as source, StateDir(where):
        backups.restore(source, file, where / STORE, name)
    print(say(RESTORED(memory=str(where / STORE), file=str(file))))


def _refuse_database(plant: Path | None, where: Path) -> None:
    """Raise StartError if the plant's memory is in no file."""
    running = find_running(where)
    store = running.store if running else store_of(plant)
    if store:
        raise StartError(IN_DATABASE(store=str(store)))
