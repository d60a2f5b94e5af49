"""`arboleda logs`: what became of tasks and what operators did, line by line, out of the flight record."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from contextlib import closing, suppress
from pathlib import Path
from typing import Annotated, Any

import typer

from arboleda.model.outside import plain

from .record_command import File, last_of, moment
from .replay_command import sentence_of
from .state import find_running
from .where import PlantFile, StateFolder, folder

LOOK_S = 0.5
LONGEST = 500  # characters of a line
WHAT = "Show what became of tasks and what operators did, out of a flight record."
HOW = "Times are local, with date. What a plant that runs did last is in its record after 2 s at most."
EXIT = "Exit status: 0 shown, 2 no record, or one that cannot be read."


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command(help=f"{WHAT}\n\n{HOW}\n\n{EXIT}", short_help=WHAT)(logs)


def logs(
    file: File = None,
    follow: Annotated[bool, typer.Option("--follow", "-f", help="Go on while the plant runs.")] = False,
    cell: Annotated[str | None, typer.Option(metavar="CELL", help="What concerns this cell only.")] = None,
    plant: PlantFile = None,
    state: StateFolder = None,
) -> None:
    from arboleda.recorder import reader

    path = last_of(file, plant, state)
    record = reader.opened(path)
    with suppress(KeyboardInterrupt):
        for unix_ns, data in record.raw() if not follow else _followed(path, folder(plant, state)):
            for concerns, line in _lines(json.loads(data)):
                if cell in (None, concerns):
                    print(plain(f"{moment(unix_ns)} {line}", LONGEST), flush=True)


def _followed(path: Path, state: Path) -> Iterator[tuple[int, bytes]]:
    """All of a record, and what comes to it while its plant runs."""
    from arboleda.recorder import files, reader

    part = files.part_at(path)
    first = reader.opened(path).paths[0]
    while True:
        with closing(reader.PartReader(first)) as opened:
            while True:
                runs = find_running(state) is not None
                yield from opened.raw()
                if opened.read.whole or not runs:
                    break
                time.sleep(LOOK_S)
        number = opened.read.numbers[-1] + 1
        following = None if part is None else files.part_path(path.parent, part.epoch, number)
        if following is None or not following.exists():
            return
        first = following


def _lines(step: dict[str, Any]) -> Iterator[tuple[str | None, str]]:
    """Of which cell it is, None for all of them, and what there is to say."""
    for row in step["messages"]:
        write = WRITERS.get(row["type"])
        if write is not None and (line := write(row)):
            yield row.get("cell"), line


def _task(row: dict[str, Any]) -> str:
    why = sentence_of(row.get("sentence"))
    return f"{row['state']:<9} {row['text']}" + (f"  {why}" if why else "")


def _act(row: dict[str, Any]) -> str:
    return sentence_of(row["sentence"])


def _refusal(row: dict[str, Any]) -> str:
    why = sentence_of(row.get("refusal"))
    return f"{row['verb']} {row['scope'] or 'plant'} was refused: {why}" if why else ""


def _absence(row: dict[str, Any]) -> str:
    return f"the plant was away for {row['seconds']:.1f} s"


def _defect(row: dict[str, Any]) -> str:
    return f"internal error in {row['cell'] or 'plant'} ({row['error']})"


WRITERS = {
    "TaskChanged": _task,
    "Journal": _act,
    "OperatorAnswer": _refusal,
    "Absence": _absence,
    "InternalError": _defect,
}
