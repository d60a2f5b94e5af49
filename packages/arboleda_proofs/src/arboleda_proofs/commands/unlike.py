"""`arboleda record unlike`: what devices of a record told that their virtual ones cannot tell."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from arboleda.cli.record import File, last_of
from arboleda.drivers import plain
from arboleda.extension import ConfigError, Phrase, PlantFile, StateFolder, say, working
from arboleda.plant_file.user_file import check_writable
from arboleda.recorder.record_text import moment

if TYPE_CHECKING:
    from arboleda_proofs.playback.unlike.reading import Unlike
    from arboleda_proofs.simulator.faults import Fault

LONGEST = 300  # characters of a line
FOUND = 1
WHAT = "Say what devices of a record told that their virtual ones cannot tell."
HOW = (
    "Each line is a finding about the virtual device, and has the fault with which it does the same. With "
    "--to they are a file without names, which simulate and prove take, and which can be sent to us. The "
    "Python files that are in the record are run: name only records that you trust."
)
EXIT = "Exit status: 0 there is nothing, 1 there is something, 2 no record, or one that cannot be read."
TIMES = Phrase("cli.unlike.times", "{what}; {times} times, first at {time}")
ONCE = Phrase("cli.unlike.once", "{what}; once, at {time}")
AS_FAULT = Phrase("cli.unlike.as_fault", "as a fault: {fault}")
NO_FAULT = Phrase("cli.unlike.no_fault", "the simulator cannot play this yet")
NOTHING = Phrase("cli.unlike.nothing", "virtual devices can tell all that these devices told")
WRITTEN = Phrase("cli.unlike.written", "{file} has {number} of these: arboleda simulate --faults {file}")
UNWRITTEN = Phrase("cli.unlike.unwritten", "{file}: cannot be written: {error}")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command("unlike", help=f"{WHAT}\n\n{HOW}\n\n{EXIT}", short_help=WHAT)(unlike)


def unlike(
    file: File = None,
    to: Annotated[
        Path | None, typer.Option("--to", metavar="FILE", help="Write it to a file, without names.")
    ] = None,
    plant: PlantFile = None,
    state: StateFolder = None,
) -> None:
    if to is not None:
        check_writable(to)
    with working():
        from arboleda.recorder import reader
        from arboleda_proofs.playback.recorded_plant import model_of
        from arboleda_proofs.playback.unlike.reading import watched

        record = reader.opened(last_of(file, plant, state))
        model = model_of(record.first.beginning)
        watch = watched(model, record.steps())
        found = watch.unlike()
    _say(found)
    if to is not None:
        from arboleda_proofs.playback.unlike.writing import as_yaml

        _write(to, as_yaml(found, model, watch.minutes))
        print(plain(say(WRITTEN(file=str(to), number=len(found))), LONGEST))
    raise typer.Exit(FOUND if found else 0)


def _say(found: Iterable[Unlike]) -> None:
    for each in found:
        what, time = each.worst.sentence, moment(each.unix_ns, "milliseconds")
        line = (
            ONCE(what=what, time=time) if each.times == 1 else TIMES(what=what, times=each.times, time=time)
        )
        print(plain(say(line), LONGEST))
        how = NO_FAULT() if each.fault is None else AS_FAULT(fault=_shown(each.fault))
        print(f"  {plain(say(how), LONGEST)}")
    if not found:
        print(say(NOTHING()))


def _shown(fault: Fault) -> str:
    """The fault as a file of faults has it."""
    figures = (f"{name} {value:.3g}" for name in ("amount", "seconds") if (value := getattr(fault, name)))
    return ", ".join([fault.kind, *figures, *([f"word {fault.word}"] if fault.word else [])])


def _write(file: Path, content: str) -> None:
    try:
        file.write_text(content, "utf-8")
    except OSError as error:
        raise ConfigError((say(UNWRITTEN(file=str(file), error=str(error.strerror))),)) from error
