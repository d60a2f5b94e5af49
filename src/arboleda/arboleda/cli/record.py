"""`arboleda record`: lists a plant's records, shows the contents of one, and copies them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path
from typing import Annotated, Any

import typer

from arboleda.model.counting import counted
from arboleda.model.errors import ConfigError
from arboleda.model.messages import ENDED
from arboleda.model.outside import plain
from arboleda.playback.record_text import moment
from arboleda.recorder.errors import NoRecord

from .overview import WholeSentences
from .plant_options import PlantFile, StateFolder, folder

LONGEST = 300  # characters of a line
EXIT = "Exit status: 0 done, 2 no record, or one that cannot be read."
File = Annotated[
    Path | None,
    typer.Argument(metavar="[FILE]", help="A file of the record. [default: the plant's last record]"),
]
cli = typer.Typer(
    cls=WholeSentences,
    help="The flight record of a plant: what went into its core and what came out, of every start.",
    no_args_is_help=True,
    rich_markup_mode=None,
)


def last_of(file: Path | None, plant: Path | None, state: Path | None) -> Path:
    """The file that is named, else one of the plant's last record; ConfigError if it has none."""
    from arboleda.recorder import files  # what reads records takes a while to load

    if file is not None:
        return file
    where = folder(plant, state) / files.FOLDER
    parts = files.parts_in(where)
    if not parts:
        raise ConfigError((f"{where} has no record: a plant that runs writes one, but for `record: off`",))
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
        print(plain(f"{where} has no record", LONGEST))
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
    rest = f"  its first {read.missing} files are gone" if read.missing else ""
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
    for unix_ns, data in record.raw():
        found.take(unix_ns, data)
    for line in _lines(record, found):
        print(plain(line, LONGEST))


def _lines(record: Any, found: Summary) -> Iterator[str]:
    first = record.first
    began = first.beginning
    yield f"plant {began.plant}, written by Arboleda {began.version}, start {began.epoch}"
    yield f"from {moment(first.began_ns)} to {moment(found.until_ns)}: {found.steps} steps"
    yield f"{len(record.paths)} files, {sum(path.stat().st_size for path in record.paths) / 1e6:.1f} MB"
    yield f"plant file: {', '.join(began.files.contents)}"
    states = [row["state"] for row in found.tasks.values()]
    ended = [state.value for state in ENDED if state.value in states]
    counts = ", ".join(f"{states.count(state)} {state}" for state in sorted(ended))
    open_ = sum(state not in ended for state in states)
    yield f"tasks: {counts or 'none ended'}{f', {open_} open' if open_ else ''}"
    if record.missing:
        yield f"its first {record.missing} files are gone, to make room: it can be read, but not replayed"
    if record.broken:
        yield f"it ends early: {record.broken}"
    elif record.last is None or not record.last.whole:
        yield "it was not closed: its plant runs, or was killed; `arboleda record recover` makes it whole"


@cli.command(
    help=f"Write a whole file of one that was not closed, for other tools.\n\n{EXIT}",
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
    until = f"; the last is of {moment(record.last_ns)}" if count else ""
    print(plain(f"{target} has {count} steps{until}", LONGEST))


EXPORT = "Write a record to one file: MCAP, to be kept or replayed elsewhere, or lines of JSON (.jsonl)."
OF_TASK = (
    "Or the tree of a task, with each change of its nodes, as viewers of BehaviorTree.CPP play it: "
    "`arboleda record export lot42.btlog --task lot42`."
)
OF_CASE = (
    "Or a case of the simulator, of all or of a task: `arboleda record export night.yaml`, then "
    "`arboleda simulate --faults night.yaml`."
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
        raise ConfigError((f"{output}: must end in {', '.join(OUTPUTS[:-1])} or {OUTPUTS[-1]}",))
    if task is not None and output.suffix not in (".btlog", ".yaml"):
        raise ConfigError((f"{output}: --task ID is for files that end in .btlog or .yaml",))
    if task is None and output.suffix == ".btlog":
        raise ConfigError((f"{output}: a .btlog is of one task; say which with --task ID",))
    record = reader.opened(last_of(file, plant, state))
    if output.suffix == ".btlog":
        from arboleda.playback import btlog_export

        print(plain(f"{output} has {btlog_export.write(record, task or '', output) / 1e3:.1f} kB", LONGEST))
        return
    if output.suffix == ".yaml":
        _export_case(record, task, output)
    elif output.suffix == ".jsonl":
        _say_exported(output, copying.as_lines(record, output))
    else:
        _say_exported(output, copying.as_mcap(record, output, record.numbers))
    if record.broken:
        print(plain(f"it ends early: {record.broken}", LONGEST))


def _say_exported(output: Path, count: int) -> None:
    print(plain(f"{output} has {count} steps, {output.stat().st_size / 1e6:.1f} MB", LONGEST))


def _export_case(record: Any, task: str | None, output: Path) -> None:
    from arboleda.plant_file.user_file import check_new
    from arboleda.playback.case import writing
    from arboleda.playback.case.reading import case_of

    check_new(output)
    if record.missing:
        gone = f"its first {record.missing} files were deleted to make room"
        raise NoRecord(f"{record.paths[0]} cannot be replayed, only read: {gone}.")
    case = case_of(record, task)
    writing.write(output, writing.as_yaml(case, record.first.beginning, output.name))
    tasks = sum(act.task is not None for act in case.people)
    acts = len(case.people) - tasks
    faults = counted(len(case.faults), "fault")
    people = f"{counted(tasks, 'task')}, {counted(acts, 'act')} of operators"
    print(plain(f"{output} has {people}, {faults} in {case.seconds:.1f} s", LONGEST))
