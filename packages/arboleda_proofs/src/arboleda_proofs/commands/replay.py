"""`arboleda record replay`: a record executed again through the core that is installed, and compared."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from arboleda import __version__
from arboleda.cli.record import File, changes, last_of
from arboleda.drivers import plain
from arboleda.extension import ConfigError, Phrase, Sentence, StateFolder, say
from arboleda.model.messages import ENDED
from arboleda.model.plant_model import PlantModel
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.preamble import Beginning
from arboleda.recorder.record_text import moment, sentence_of
from arboleda_proofs.playback.recorded_plant import model_of, versions_of

if TYPE_CHECKING:
    from arboleda.recorder.reader import Record
    from arboleda.recorder.steps import RecordedStep
    from arboleda_proofs.playback.replay import ReplayedStep

    from .fork import Options

PAGE_ALONE = Phrase(
    "cli.replay.page_alone",
    "--page shows a record as it was: only --until, --task and --port go with it",
)
NO_TIME = Phrase("cli.replay.no_time", "{option} {text}: is no time; write 2026-11-22T03:15:00, or 03:15:00")
NO_TASK = Phrase("cli.replay.no_task", "--task {task}: there is no such task in this record")
ONLY_READ = Phrase(
    "cli.replay.only_read",
    "{file} cannot be replayed, only read: its first {missing} files were deleted to make room.",
)
NOT_COMPARED = Phrase("cli.replay.not_compared", "{why}, so that nothing was compared.")
NO_STEP = Phrase("cli.replay.no_step", "{file} has no step")
NO_STEP_UNTIL = Phrase("cli.replay.no_step_until", "{file} has no step up to the time that --until names")
READ = Phrase("cli.replay.read", "{number} read, then {broken}")
READ_OF = Phrase("cli.replay.read_of", "{there} steps, {number} read, then {broken}")
READ_ARE_EQUAL = Phrase("cli.replay.read_are_equal", "{read}; those that were read are equal")
ENDS_EARLY = Phrase("cli.replay.ends_early", "the record ends early: {broken}")
ALL_EQUAL = Phrase("cli.replay.all_equal", "{number} steps, all equal")
OTHER_VERSION = Phrase(
    "cli.replay.other_version", "note: recorded by Arboleda {recorded}, replayed by {here}"
)
OTHER_PLANT = Phrase(
    "cli.replay.other_plant", "note: replayed with {plant} instead of the plant file of the record"
)
DEADLINE = Phrase("cli.replay.deadline", "no event, a deadline")
DIFFERS_AT = Phrase("cli.replay.differs_at", "{equal} steps are equal; step {number}, of {time}, is not")
WENT_IN = Phrase("cli.replay.went_in", "what went in: {events}")
WAS = Phrase("cli.replay.was", "{field} was {before}, is now {now}")

DIFFERS = 1
ENDS = {state.value for state in ENDED}
LONGEST = 500  # characters of a line
SHOWN = 120  # characters of a value that differs
WHAT = "Execute a record again, and compare every step with what it was."
HOW = (
    "It runs the plant file and the Python files that are in the record: replay only records that you trust."
)
EXIT = (
    "Exit status: 0 all steps are equal, or all of a fork happens as recorded; 1 something does not, or is "
    "damaged; 2 no record, or one that cannot be replayed."
)

Until = Annotated[
    str | None,
    typer.Option(metavar="TIME", help="Up to 2026-11-22T03:15:00, or 03:15:00 of its first day."),
]
Task = Annotated[
    str | None,
    typer.Option(metavar="ID", help="Show this task only, up to its end; a fork begins as it does."),
]
Speed = Annotated[
    float | None,
    typer.Option(metavar="X", min=0.01, help="X times as fast as it was. [default: at once]"),
]
Plant = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Take another plant file: where it first acts otherwise, or what it does in a fork.",
    ),
]
ForkAt = Annotated[
    str | None,
    typer.Option(
        metavar="TIME", help="Go on from there with virtual devices, and say what turns out otherwise."
    ),
]
Setting = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="A fork with another value, e.g. timing.stale_after_s=3."
    ),
]
Recipe = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="A fork whose new tasks take their recipes from this Python file."),
]
Healthy = Annotated[bool, typer.Option("--healthy", help="A fork in which devices have no faults any more.")]
OnPage = Annotated[
    bool, typer.Option("--page", help="Look at it on the page, from --until or the end of --task on.")
]
Port = Annotated[
    int | None, typer.Option(metavar="PORT", min=0, max=65535, help="Port of the page. [default: 8080]")
]


@dataclass(frozen=True)
class Chosen:
    """The part of a record that somebody wants to see, and its speed."""

    until_ns: int | None = None
    task: str | None = None
    speed: float | None = None


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command(help=f"{WHAT}\n\n{HOW}\n\n{EXIT}", short_help=WHAT)(replay)


def replay(
    file: File = None,
    until: Until = None,
    task: Task = None,
    speed: Speed = None,
    plant: Plant = None,
    fork_at: ForkAt = None,
    setting: Setting = None,
    recipe: Recipe = None,
    healthy: Healthy = False,
    page: OnPage = False,
    port: Port = None,
    state: StateFolder = None,
) -> None:
    from arboleda.recorder import reader

    record = reader.opened(last_of(file, None, state))
    forks = any((fork_at, setting, recipe, healthy))
    if page:
        if speed or plant or forks:
            raise ConfigError((say(PAGE_ALONE()),))
        _show(record, until, task, port)
        return
    _refuse_part(record)
    for line in _notes(record.first.beginning, plant):
        _say(line)
    end_ns = _time("--until", until, record)
    if not forks:
        _compare(record, plant, Chosen(end_ns, task, speed))
        return
    from . import fork

    changed = fork.Options(settings=tuple(setting or ()), plant=plant, recipe=recipe, healthy=healthy)
    at_ns = _time("--fork-at", fork_at, record)
    _fork(record, replace(changed, at_ns=at_ns, task=task, until_ns=end_ns))


def _refuse_part(record: Record) -> None:
    if record.missing:
        raise NoRecord(ONLY_READ(file=str(record.paths[0]), missing=record.missing))


def _compare(record: Record, plant: Path | None, chosen: Chosen) -> None:
    """Compare every step with the recorded one, and print the result."""
    last = _run(record, model_of(record.first.beginning, plant), chosen)
    if last is None:
        raise NoRecord(NOT_COMPARED(why=_nothing(record, chosen)))
    _finish(record, last)


def _nothing(record: Record, chosen: Chosen) -> Sentence:
    if record.broken:
        return _extent(record, 0)
    return (NO_STEP if chosen.until_ns is None else NO_STEP_UNTIL)(file=str(record.paths[0]))


def _extent(record: Record, number: int) -> Sentence:
    """The number of its steps that were read, and the damage that ended the reading."""
    from arboleda.recorder import reader

    there = reader.steps_there(record.paths)
    if there is not None and there >= number:
        return READ_OF(there=there, number=number, broken=str(record.broken))
    return READ(number=number, broken=str(record.broken))


def _fork(record: Record, options: Options) -> None:
    """Fork the record and print the result."""
    from arboleda_proofs.playback.fork.run import forked

    from . import fork

    found = forked(record.first.beginning, record.steps(), fork.request_of(record, options), sentence_of)
    if found.difference is not None:
        _finish(record, found.difference)
    for line in fork.lines(found, options):
        _say(line)
    if record.broken:
        _say(say(ENDS_EARLY(broken=str(record.broken))))
    if not all(pair.same for pair in fork.compared(found, options.task)):
        raise typer.Exit(DIFFERS)


def _show(record: Record, until: str | None, task: str | None, port: int | None) -> None:
    """Show the page at the end of a task or at a time; else at the last failure."""
    from arboleda_proofs.past import replay_page  # its libraries take a second

    at_ns = _time("--until", until, record)
    query = {"at": "task" if task else "failure" if at_ns is None else f"{at_ns / 1e9:.3f}"}
    of_task = {"tab": "tasks", "task": task} if task else {}
    replay_page.show(record, model_of(record.first.beginning, None), query | of_task, port)


def _finish(record: Record, last: ReplayedStep) -> None:
    """Print the result."""
    if last.difference is not None:
        for line in _difference(last):
            _say(line)
        raise typer.Exit(DIFFERS)
    if record.broken:
        _say(say(READ_ARE_EQUAL(read=_extent(record, last.number))))
        raise typer.Exit(DIFFERS)
    _say(say(ALL_EQUAL(number=last.number)))


def _notes(beginning: Beginning, plant: Path | None) -> Iterator[str]:
    if beginning.version != __version__:
        yield say(OTHER_VERSION(recorded=beginning.version, here=__version__))
    if plant is not None:
        yield say(OTHER_PLANT(plant=str(plant)))


def _time(option: str, text: str | None, record: Record) -> int | None:
    """A time in ns of Unix time; None without one, ConfigError for text that is no time."""
    if text is None:
        return None
    day = datetime.fromtimestamp(record.first.began_ns / 1e9).date().isoformat()
    for candidate in (text, f"{day}T{text}"):
        try:
            return int(datetime.fromisoformat(candidate).timestamp() * 1e9)
        except (OverflowError, ValueError):
            continue
    raise ConfigError((say(NO_TIME(option=option, text=plain(text, 40))),))


def _run(record: Record, model: PlantModel, chosen: Chosen) -> ReplayedStep | None:
    """Execute the steps again, print the changes of tasks, and return the last step."""
    from arboleda_proofs.playback.replay import plant_of, replayed

    last: ReplayedStep | None = None
    pace = Pace(chosen.speed)
    known = False
    plant = plant_of(record.first.beginning, model, versions_of(record))
    for last in replayed(plant, _until(record, chosen.until_ns)):
        pace.wait(last.recorded.now)
        rows = [row for row in changes(last.recorded.result) if chosen.task in (None, row["task"])]
        for row in rows:
            known = True
            _say(f"{moment(last.recorded.unix_ns, 'milliseconds')} {_line(row)}")
        if chosen.task is not None and any(row["state"] in ENDS for row in rows):
            break
    if chosen.task is not None and not known and (last is None or last.difference is None):
        raise ConfigError((say(NO_TASK(task=plain(chosen.task, 80))),))
    return last


def _until(record: Record, end_ns: int | None) -> Iterator[RecordedStep]:
    for step in record.steps():
        if end_ns is not None and step.unix_ns > end_ns:
            return
        yield step


class Pace:
    """Pace: waits, so that a replay is `speed` times as fast as its record; for None not at all."""

    def __init__(self, speed: float | None) -> None:
        self._speed = speed
        self._begun: tuple[float, float] | None = None

    def wait(self, now: float) -> None:
        if self._speed is None:
            return
        if self._begun is None:
            self._begun = now, time.monotonic()
        first, at = self._begun
        time.sleep(max(0.0, at + (now - first) / self._speed - time.monotonic()))


def _line(row: dict[str, Any]) -> str:
    sentence = sentence_of(row.get("sentence"))
    why = f"  {sentence}" if sentence else ""
    return f"{row['state']:<9} {row['text']} (id {row['task']}){why}"


def _difference(last: ReplayedStep) -> Iterator[str]:
    step, found = last.recorded, last.difference
    assert found is not None
    events = ", ".join(_event(each) for each in step.events) or DEADLINE()
    when = moment(step.unix_ns, "microseconds")
    yield say(DIFFERS_AT(equal=last.number - 1, number=last.number, time=when))
    yield f"  {say(WENT_IN(events=events))}"
    yield f"  {say(WAS(field=found.field, before=_value(found.recorded), now=_value(found.now)))}"


def _event(event: Any) -> str:
    whose = getattr(event, "robot", None) or getattr(event, "text", None) or getattr(event, "scope", None)
    return type(event).__name__ + (f" {whose}" if whose else "")


def _value(value: Any) -> str:
    return plain(json.dumps(value), SHOWN)


def _say(line: str) -> None:
    print(plain(line, LONGEST), flush=True)
