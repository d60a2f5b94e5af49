"""`arboleda record logs`: what became of tasks and cells and what operators did, from the flight records."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from contextlib import closing, suppress
from pathlib import Path
from typing import Annotated, Any

import typer
import yaml

from arboleda.model.errors import ConfigError
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.record_text import moment, sentence_of
from arboleda.runtime.state import find_running

from .language import allowed, say, word
from .plant_options import PlantFile, StateFolder, folder
from .record import last_of

LOOK_S = 0.5
STEPS, EVENTS = (
    "/arboleda/steps",
    "/arboleda/events",
)  # topics of records, written here as their module is slow to import
LONGEST = 500  # characters of a line
WHAT = "Show what became of tasks and cells and what operators did, of all starts that are recorded."
HOW = "Times are local, with date. What a plant that runs did last is in its record after 2 s at most."
EXIT = "Exit status: 0 shown, 2 no record, one that cannot be read, or no such cell."
File = Annotated[
    Path | None,
    typer.Argument(metavar="FILE", help="A file of the record of one start. [default: all records]"),
]
NEWS = frozenset({"held", "stopped", "aborted"})  # states of cells that nothing else says
Told = tuple[str, int, bytes]  # topic, ns of Unix time, content
STARTED = Phrase("cli.logs.started", "started")
OF_ALL = Phrase("cli.logs.of_all", "plant")  # where no cell is named
LEFT_OUT = Phrase("cli.logs.left_out", "left out: {error}")
NO_SUCH_CELL = Phrase("cli.logs.no_cell", "no record has a cell '{cell}'; {others}")
WAS_AWAY = Phrase("cli.logs.was_away", "the plant was away for {seconds} s")
DEFECT = Phrase("cli.logs.defect", "internal error in {where} ({error})")
REFUSED_VERB = Phrase("cli.logs.refused", "{verb} {scope} was refused: {why}")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command(help=f"{WHAT}\n\n{HOW}\n\n{EXIT}", short_help=WHAT)(logs)


def logs(
    file: File = None,
    follow: Annotated[
        bool, typer.Option("--follow", "-f", help="Go on showing what happens while the plant runs.")
    ] = False,
    cell: Annotated[str | None, typer.Option(metavar="CELL", help="Only what concerns this cell.")] = None,
    plant: PlantFile = None,
    state: StateFolder = None,
) -> None:
    from arboleda.recorder import reader

    last = last_of(file, plant, state)
    paths = [last] if file is not None else [*_starts(last), last]
    if cell is not None:
        _refuse_unknown(cell, paths)
    with suppress(KeyboardInterrupt):
        for path in paths:
            goes_on = follow and path is last
            messages = _followed(path, folder(plant, state)) if goes_on else _all(reader.opened(path))
            began = reader.opened(path).first
            if cell is None:
                _print(began.began_ns, f"{say(STARTED()):<9} {began.beginning.plant}")
            for topic, unix_ns, data in messages:
                for concerns, line in _lines(topic, json.loads(data)):
                    if cell in (None, concerns):
                        _print(unix_ns, line)


def _print(unix_ns: int, line: str) -> None:
    print(plain(f"{moment(unix_ns)} {line}", LONGEST), flush=True)


def _starts(last: Path) -> list[Path]:
    """A file of each start before the last one, oldest first; an unreadable one is reported and left out."""
    from arboleda.recorder import files, reader

    first_of = {part.epoch: part.path for part in reversed(files.parts_in(last.parent))}
    newest = files.part_at(last)
    found = []
    for epoch in sorted(first_of):
        if newest is None or epoch >= newest.epoch:
            continue
        try:
            reader.opened(first_of[epoch])
        except NoRecord as error:
            typer.echo(plain(say(LEFT_OUT(error=str(error))), LONGEST), err=True)
        else:
            found.append(first_of[epoch])
    return found


def _refuse_unknown(cell: str, paths: list[Path]) -> None:
    """Raise ConfigError for a cell that no plant file of these records has."""
    from arboleda.recorder import reader

    known: dict[str, None] = {}
    for path in paths:
        recorded = reader.opened(path).first.beginning.files
        content = yaml.safe_load(recorded.contents.get(recorded.plant, b"")) or {}
        known |= dict.fromkeys(content.get("cells", {}))
    if known and cell not in known:
        raise ConfigError((say(NO_SUCH_CELL(cell=cell, others=allowed(cell, known))),))


def _all(record: Any) -> Iterator[Told]:
    for opened in record.readers():
        yield from opened.messages_of(STEPS, EVENTS)


def _followed(path: Path, state: Path) -> Iterator[Told]:
    """The messages of a record, and those that are added while its plant runs."""
    from arboleda.recorder import files, reader

    part = files.part_at(path)
    first = reader.opened(path).paths[0]
    while True:
        with closing(reader.PartReader(first)) as opened:
            while True:
                runs = find_running(state) is not None
                yield from opened.messages_of(STEPS, EVENTS)
                if opened.read.whole or not runs:
                    break
                time.sleep(LOOK_S)
        number = opened.read.numbers[-1] + 1
        following = None if part is None else files.part_path(path.parent, part.epoch, number)
        if following is None or not following.exists():
            return
        first = following


def _lines(topic: str, message: dict[str, Any]) -> Iterator[tuple[str | None, str]]:
    """The lines of a message, each with its cell, None for all of them."""
    if topic == EVENTS and message["kind"] == "cell" and message["what"] in NEWS:
        why = sentence_of(message["sentence"], say)
        yield (
            message["cell"],
            f"{word('cell_state', message['what']):<9} {message['subject']}" + (f"  {why}" if why else ""),
        )
    for row in message["messages"] if topic == STEPS else ():
        write = WRITERS.get(row["type"])
        if write is not None and (line := write(row)):
            yield row.get("cell"), line


def _task(row: dict[str, Any]) -> str:
    why = sentence_of(row.get("sentence"), say)
    return f"{word('task_state', row['state']):<9} {row['text']}" + (f"  {why}" if why else "")


def _act(row: dict[str, Any]) -> str:
    return sentence_of(row["sentence"], say)


def _refusal(row: dict[str, Any]) -> str:
    why = sentence_of(row.get("refusal"), say)
    return say(REFUSED_VERB(verb=row["verb"], scope=row["scope"] or OF_ALL(), why=why)) if why else ""


def _absence(row: dict[str, Any]) -> str:
    return say(WAS_AWAY(seconds=f"{row['seconds']:.1f}"))


def _defect(row: dict[str, Any]) -> str:
    return say(DEFECT(where=row["cell"] or OF_ALL(), error=row["error"]))


WRITERS = {
    "TaskChanged": _task,
    "Journal": _act,
    "OperatorAnswer": _refusal,
    "Absence": _absence,
    "InternalError": _defect,
}
