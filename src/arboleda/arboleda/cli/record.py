"""`arboleda record`: lists a plant's records, shows the contents of one, and copies them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path
from typing import Annotated, Any

import typer

from arboleda.host.packages import extra
from arboleda.model.errors import ConfigError
from arboleda.model.messages import ENDED
from arboleda.model.outside import plain
from arboleda.model.packages import PROOFS
from arboleda.model.sentence import Phrase
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.record_text import moment

from .language import say, word
from .overview import WholeSentences
from .plant_options import PlantFile, StateFolder, folder
from .working import working

LONGEST = 300  # characters of a line
EXIT = "Exit status: 0 done, 2 no record, or one that cannot be read."
File = Annotated[
    Path | None,
    typer.Argument(metavar="FILE", help="A file of the record. [default: the plant's last record]"),
]
cli = typer.Typer(
    cls=WholeSentences,
    help="The flight record of a plant: what went into its core and what came out, of every start.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
NO_RECORD_YET = Phrase(
    "cli.record.none_yet",
    "{folder} has no record: a plant that runs writes one, but for `record: off`",
)
NO_RECORD = Phrase("cli.record.none", "{folder} has no record")
FIRST_GONE = Phrase("cli.record.first_gone", "its first {number} files are gone")
WRITTEN_BY = Phrase("cli.record.written_by", "plant {plant}, written by Arboleda {version}, start {epoch}")
SPAN = Phrase("cli.record.span", "from {begin} to {end}: {steps} steps")
SIZE = Phrase("cli.record.size", "{files} files, {megabytes} MB")
PLANT_FILES = Phrase("cli.record.plant_files", "plant file: {files}")
TASKS = Phrase("cli.record.tasks", "tasks: {counts}")
NONE_ENDED = Phrase("cli.record.none_ended", "none ended")
OPEN = Phrase("cli.record.open", "{number} open")
ONLY_READ = Phrase(
    "cli.record.only_read",
    "its first {number} files are gone, to make room: it can be read, but not replayed",
)
ENDS_EARLY = Phrase("cli.record.ends_early", "it ends early: {why}")
NOT_CLOSED = Phrase(
    "cli.record.not_closed",
    "it was not closed: its plant runs, or was killed; `arboleda record recover` makes it whole",
)
HAS_STEPS = Phrase("cli.record.has_steps", "{file} has {steps} steps")
HAS_STEPS_UNTIL = Phrase("cli.record.has_steps_until", "{file} has {steps} steps; the last is of {time}")
HAS_STEPS_SIZE = Phrase("cli.record.has_steps_size", "{file} has {steps} steps, {megabytes} MB")
HAS_KB = Phrase("cli.record.has_kb", "{file} has {kilobytes} kB")
BAD_ENDING = Phrase("cli.record.bad_ending", "{file}: must end in {endings}")
TASK_OF = Phrase("cli.record.task_of", "{file}: --task ID is for files that end in .btlog or .yaml")
OF_ONE_TASK = Phrase("cli.record.of_one_task", "{file}: a .btlog is of one task; say which with --task ID")


def last_of(file: Path | None, plant: Path | None, state: Path | None) -> Path:
    """The file that is named, else one of the plant's last record; ConfigError if it has none."""
    from arboleda.recorder import files  # what reads records takes a while to load

    if file is not None:
        return file
    where = folder(plant, state) / files.FOLDER
    parts = files.parts_in(where)
    if not parts:
        raise ConfigError((say(NO_RECORD_YET(folder=str(where))),))
    return parts[-1].path


@cli.command("list")
def list_records(plant: PlantFile = None, state: StateFolder = None) -> None:
    """List the plant's records, the oldest first: when, for how long, how large, and the file."""
    from arboleda.recorder import files

    where = folder(plant, state) / files.FOLDER
    records: dict[int, list[files.Part]] = {}
    for part in files.parts_in(where):
        records.setdefault(part.epoch, []).append(part)
    if not records:
        print(plain(say(NO_RECORD(folder=str(where))), LONGEST))
    for parts in records.values():
        print(plain(_row(parts), LONGEST))


def _row(parts: list[Any]) -> str:
    from arboleda.recorder import reader

    size = f"{sum(part.bytes for part in parts) / 1e6:8.1f} MB"
    try:
        read = reader.opened(parts[0].path)
        ended_s = parts[-1].path.stat().st_mtime
    except (NoRecord, OSError) as error:
        return f"{'?':<28}{size}  {parts[0].path}  {error}"
    began = moment(read.first.began_ns)
    lasted = timedelta(seconds=max(0, round(ended_s - read.first.began_ns / 1e9)))
    rest = f"  {say(FIRST_GONE(number=read.missing))}" if read.missing else ""
    return f"{began:<20}{lasted!s:>16}{size}  {parts[0].path}{rest}"


@dataclass
class Summary:
    """The contents of a record, counted."""

    steps: int = 0
    until_ns: int = 0
    tasks: dict[str, dict[str, Any]] = field(default_factory=dict)

    def take(self, unix_ns: int, data: bytes) -> None:
        self.steps += 1
        self.until_ns = unix_ns
        if b'"TaskChanged"' in data:
            for row in changes(json.loads(data)):
                self.tasks[row["task"]] = row


def changes(step: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """The changes of tasks in a step; refused requests are none."""
    for row in step["messages"]:
        if row["type"] == "TaskChanged" and row["task"]:
            yield row


@cli.command(help=f"Say what is in a record.\n\n{EXIT}", short_help="Say what is in a record.")
def info(file: File = None, plant: PlantFile = None, state: StateFolder = None) -> None:
    from arboleda.recorder import reader

    record = reader.opened(last_of(file, plant, state))
    found = Summary(until_ns=record.first.began_ns)
    with working():
        for unix_ns, data in record.raw():
            found.take(unix_ns, data)
    for line in _lines(record, found):
        print(plain(line, LONGEST))


def _lines(record: Any, found: Summary) -> Iterator[str]:
    first = record.first
    began = first.beginning
    yield say(WRITTEN_BY(plant=began.plant, version=began.version, epoch=began.epoch))
    yield say(SPAN(begin=moment(first.began_ns), end=moment(found.until_ns), steps=found.steps))
    size = sum(path.stat().st_size for path in record.paths)
    yield say(SIZE(files=len(record.paths), megabytes=f"{size / 1e6:.1f}"))
    yield say(PLANT_FILES(files=tuple(began.files.contents)))
    states = [row["state"] for row in found.tasks.values()]
    ended = [state.value for state in ENDED if state.value in states]
    counts = ", ".join(f"{states.count(state)} {word('task_state', state)}" for state in sorted(ended))
    open_ = sum(state not in ended for state in states)
    left = [say(OPEN(number=open_))] if open_ else []
    yield say(TASKS(counts=", ".join([counts or say(NONE_ENDED()), *left])))
    if record.missing:
        yield say(ONLY_READ(number=record.missing))
    if record.broken:
        yield say(ENDS_EARLY(why=str(record.broken)))
    elif record.last is None or not record.last.whole:
        yield say(NOT_CLOSED())


@cli.command(
    help=f"Write a whole file from a record that was not closed, for other tools.\n\n{EXIT}",
    short_help="Write a whole file of one that was not closed.",
)
def recover(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A file of a record.")],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="The file to make. [default: FILE.recovered.mcap]")
    ] = None,
) -> None:
    from arboleda.recorder import copying, reader

    record = reader.alone(file)
    target = output or file.with_name(f"{file.stem}.recovered.mcap")
    count = copying.as_mcap(record, target, record.first.numbers)
    last = HAS_STEPS_UNTIL(file=str(target), steps=count, time=moment(record.last_ns)) if count else None
    print(plain(say(last or HAS_STEPS(file=str(target), steps=count)), LONGEST))


EXPORT = "Write a record to one file: MCAP, to be kept or replayed elsewhere, or lines of JSON (.jsonl)."
OF_TASK = (
    "Or the tree of a task, with each change of its nodes, as viewers of BehaviorTree.CPP play it: "
    "`arboleda record export lot42.btlog --task lot42`."
)
OF_CASE = (
    "Or a case for the simulator, of the whole record or of a task: `arboleda record export night.yaml`, "
    "then `arboleda simulate --faults night.yaml`."
)
OUTPUTS = (".mcap", ".jsonl", ".btlog", ".yaml")


@cli.command(help=f"{EXPORT}\n\n{OF_TASK}\n\n{OF_CASE}\n\n{EXIT}", short_help=EXPORT)
def export(
    output: Annotated[
        Path, typer.Argument(metavar="OUTPUT", help=f"The file to make: {', '.join(OUTPUTS)}.")
    ],
    file: File = None,
    task: Annotated[
        str | None, typer.Option(metavar="ID", help="The task, for .btlog and, from its beginning, .yaml.")
    ] = None,
    plant: PlantFile = None,
    state: StateFolder = None,
) -> None:
    from arboleda.recorder import copying, reader

    if output.suffix not in OUTPUTS:
        raise ConfigError((say(BAD_ENDING(file=str(output), endings=OUTPUTS)),))
    if task is not None and output.suffix not in (".btlog", ".yaml"):
        raise ConfigError((say(TASK_OF(file=str(output))),))
    if task is None and output.suffix == ".btlog":
        raise ConfigError((say(OF_ONE_TASK(file=str(output))),))
    record = reader.opened(last_of(file, plant, state))
    if output.suffix == ".btlog":
        size = extra("btlog", PROOFS, str(output))(record, task or "", output)
        print(plain(say(HAS_KB(file=str(output), kilobytes=f"{size / 1e3:.1f}")), LONGEST))
        return
    if output.suffix == ".yaml":
        extra("case", PROOFS, str(output))(record, task, output)
    elif output.suffix == ".jsonl":
        _say_exported(output, copying.as_lines(record, output))
    else:
        _say_exported(output, copying.as_mcap(record, output, record.numbers))
    if record.broken:
        print(plain(say(ENDS_EARLY(why=str(record.broken))), LONGEST))


def _say_exported(output: Path, count: int) -> None:
    megabytes = f"{output.stat().st_size / 1e6:.1f}"
    print(plain(say(HAS_STEPS_SIZE(file=str(output), steps=count, megabytes=megabytes)), LONGEST))


def add_to(parent: typer.Typer) -> None:
    """Add the group."""
    parent.add_typer(cli, name="record")
