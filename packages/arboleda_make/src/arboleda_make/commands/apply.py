"""The command `arboleda apply`: what was changed is shown, put to work and kept."""

from __future__ import annotations

import getpass
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timezone
from pathlib import Path
from typing import Annotated

import typer

from arboleda.cli.check import WARNING
from arboleda.cli.language import finding
from arboleda.drivers import plain
from arboleda.extension import (
    ArboledaError,
    ConfigError,
    Phrase,
    PlantFile,
    StateFolder,
    client,
    say,
    working,
)
from arboleda.plant_check import checks, draft_check
from arboleda.plant_file import loader
from arboleda.plant_file.versions import Version, Versions, version_of, whole
from arboleda.runtime import at_work
from arboleda.runtime.state import Running, default_state, find_running
from arboleda_make.client.draft import CHECKED_S
from arboleda_make.versions.change import Change
from arboleda_make.versions.changes import changes
from arboleda_make.versions.restart import needing_restart

LONGEST = 500  # characters of a line
NOT_TAKEN = 1
Back = Annotated[
    int | None,
    typer.Option("--back", metavar="N", min=1, help="Bring version N back: its plant file and its trees."),
]
Note = Annotated[str, typer.Option("--note", metavar="TEXT", help="A line that is kept with the version.")]
Restart = Annotated[
    bool,
    typer.Option(
        "--restart", help="Where a change needs it, have the plant restart once all its cells rest."
    ),
]
Listed = Annotated[
    bool,
    typer.Option(
        "--list", help="List the versions that were put to work, oldest first, with what each has changed."
    ),
]
Yes = Annotated[bool, typer.Option("--yes", help="Do not ask.")]
SHIPPED = Phrase(
    "cli.apply.shipped",
    "the shipped plant cannot be changed: write one of your own with `arboleda new`, or copy its file, "
    "and name it with --plant",
)
NEEDS_RESTART = Phrase(
    "cli.apply.needs_restart",
    "the plant that runs goes on as it is, and has it from its next start on; so has the next leader of"
    " two, as after `arboleda handover`; `--restart`, or the page, has it restart once all its cells "
    "rest",
)
RESTARTS = Phrase(
    "cli.apply.restarts",
    "the plant that runs restarts with it once all its cells rest; until then no further task begins",
)
FIRST_VERSION = Phrase("cli.apply.first", "nothing was kept before; this is the first version")
VERSION_OF = Phrase("cli.apply.version_of", "version {number} of {time}")
STARTED_WITH = Phrase("cli.apply.started_with", "what the plant was started with at {time}")
BRING_BACK = Phrase("cli.apply.bring_back", "Bring its files back?")
NOTHING_TO_DO = Phrase("cli.apply.nothing", "{file}: as in {base}; there is nothing to put to work")
COMPARED = Phrase("cli.apply.compared", "{file}: compared with {base}:")
A_RESTART = Phrase(
    "cli.apply.a_restart",
    "this needs a restart, or a handover; until then the plant that runs goes on as it is:",
)
PUT_TO_WORK = Phrase("cli.apply.put_to_work", "Put this to work?")
AGAIN = Phrase("cli.apply.again", "version {number} again")
KEPT_FOR_NEXT = Phrase(
    "cli.apply.kept_for_next",
    "version {number} is kept; the next start of the plant has it",
)
KEPT = Phrase("cli.apply.kept", "version {number} is kept")
NONE_KEPT = Phrase("cli.apply.none_kept", "{file}: no version is kept; `arboleda apply` keeps one")
NOT_BACK = Phrase("cli.apply.not_back", "version {number} cannot be brought back:")
OTHER_FILE = Phrase(
    "cli.apply.other_file",
    "{file}: another file than with version {number}; it stays as it is",
)
AS_STARTED = Phrase("cli.apply.as_started", "as the plant was started")
NOT_TAKEN_NOW = Phrase(
    "cli.apply.not_taken",
    "the plant that runs goes on as it is, and has it from its next start on: {why}",
)
TAKES_IT = Phrase("cli.apply.takes_it", "{cell} takes it {when}")
CANCELLED = Phrase(
    "cli.apply.cancelled",
    "task {task} waited, and is cancelled: the plant does not take it any more",
)
AT_WORK = Phrase("cli.apply.at_work", "at work")


@dataclass(frozen=True, kw_only=True)
class _Base:
    """Basis of a comparison: an earlier version, None for nothing, and the process that runs the plant."""

    version: Version | None
    running: Running | None

    @property
    def name(self) -> str:
        if self.version is None:
            return say(FIRST_VERSION())
        number, time = self.version.number, _minute(self.version)
        return say(VERSION_OF(number=number, time=time) if number else STARTED_WITH(time=time))


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(apply)


def apply(
    plant: PlantFile = None,
    back: Back = None,
    note: Note = "",
    restart: Restart = False,
    yes: Yes = False,
    listed: Listed = False,
    state: StateFolder = None,
) -> None:
    """Check a plant file and all that it uses, show how it differs from what is at work, and put it to work.

    Versions are kept in the folder .arboleda beside the plant file; `--list` has them, `--back N` brings one
    back. A plant that runs takes the version: each
    cell once its task has ended. What needs a restart is said before anything is done. Exit status: 0 kept,
    or nothing to keep; 1 you said no, or the plant that runs has not taken it; 2 the check refuses it, and
    nothing was changed.
    """
    file = _named(plant)
    kept = Versions(file)
    if listed:
        _list(file, kept, state)
        return
    kept.go_on()
    wanted = _on_disk(file) if back is None else _checked(file, kept, kept.find(back))
    base = _base(wanted.plant_name, kept, state)
    lines = tuple(each.words for each in _changes(base.version, wanted))
    if base.version is not None and not lines:
        if back is not None and not kept.is_in_place(wanted.version):
            _ask(say(BRING_BACK()), yes=yes)
            kept.bring_back(wanted.version)
        _print(say(NOTHING_TO_DO(file=str(file), base=base.name)))
        return
    compared = say(COMPARED(file=str(file), base=base.name))
    _print(compared if base.version else f"{file}: {base.name}")
    for line in lines:
        _print(f"  {finding(line)}")
    if base.running is not None and (needing := needing_restart(_changes(base.version, wanted))):
        _print(say(A_RESTART()))
        for line in needing:
            _print(f"  {finding(line)}")
    _ask(say(PUT_TO_WORK()), yes=yes)
    if back is not None:
        kept.bring_back(wanted.version)
        wanted = replace(wanted, version=version_of(loader.load_with_files(file)[1], at=_now()))
    fresh = replace(wanted.version, changes=lines, note=note or (str(AGAIN(number=back)) if back else ""))
    number = _keep(kept, base, fresh)
    if base.running is None:
        _print(say(KEPT_FOR_NEXT(number=number)))
        return
    _print(say(KEPT(number=number)))
    _put_to_work(number, plant, state, restarts=restart)


def _list(file: Path, kept: Versions, state: Path | None) -> None:
    """Print the versions, oldest first, with what each has changed."""
    base = _base(loader.load(file, recipes=False).name, kept, state)
    runs = base.version.digest if base.running and base.version else ""
    known = kept.all()
    if not known:
        _print(say(NONE_KEPT(file=str(file))))
    for each in known:
        _print("  ".join(_heading(each, is_running=each.digest == runs)))
        for line in each.changes:
            _print(f"  {finding(line)}")


@dataclass(frozen=True, kw_only=True)
class _Wanted:
    """The version to be put to work, the name of its plant, and whether it is one of before."""

    version: Version
    plant_name: str
    comes_back: bool = False


def _ask(question: str, *, yes: bool) -> None:
    if not yes:
        typer.confirm(question, abort=True)


def _named(plant: Path | None) -> Path:
    if plant is None:
        raise ConfigError((say(SHIPPED()),))
    return plant


def _on_disk(file: Path) -> _Wanted:
    """The files as they are now; ConfigError with every problem. Prints what `check` warns of."""
    with working():
        model, files = loader.load_with_files(file)
    for warning in checks.warnings(model):
        _print(say(WARNING(file=str(file), warning=finding(warning))))
    return _Wanted(version=version_of(files, at=_now()), plant_name=model.name)


def _checked(file: Path, kept: Versions, version: Version) -> _Wanted:
    """A version that is to come back; ConfigError where it is no plant beside the other files of today."""
    found = draft_check.check(version.files, file)
    if found.plant is None:
        raise ConfigError((say(NOT_BACK(number=version.number)), *found.problems))
    for warning in found.warnings:
        _print(say(WARNING(file=str(file), warning=finding(warning))))
    for name in kept.others_now(version):
        _print(say(OTHER_FILE(file=str(name), number=version.number)))
    return _Wanted(version=version, plant_name=found.plant.name, comes_back=True)


def _base(plant_name: str, kept: Versions, state: Path | None) -> _Base:
    """The version at work in the plant that runs; where none runs, the one that was kept last."""
    where = state or default_state(plant_name)
    running, started, last = find_running(where), at_work.version(where), kept.last()
    if running is not None and started is not None:
        same = next((each for each in reversed(kept.all()) if each.digest == started.digest), None)
        return _Base(version=same or started, running=running)
    return _Base(version=last or started, running=running)


def _changes(base: Version | None, wanted: _Wanted) -> Sequence[Change]:
    """Changes that a version makes to what is at work, of which there may be nothing."""
    if base is None:
        return ()
    sides = [base.files, wanted.version.files] if wanted.comes_back else [whole(base), whole(wanted.version)]
    return changes(*sides)


def _keep(kept: Versions, base: _Base, version: Version) -> int:
    """Keep a version, before it what is at work if no version has that; its number."""
    before = base.version
    if before is not None and not before.number:
        kept.keep(replace(before, note=str(AS_STARTED())))
    last = kept.last()
    if last is not None and last.digest == version.digest:  # kept before, and not at work yet
        return last.number
    return kept.keep(replace(version, by=getpass.getuser())).number


def _put_to_work(number: int, plant: Path | None, state: Path | None, *, restarts: bool) -> None:
    """Have the plant that runs take a version, and print when each cell does; status 1 if it does not."""
    reached, by = client(plant, state), {"name": getpass.getuser()}
    try:
        path = f"/api/versions/{number}/put"
        answer = reached.post(path, by, is_repeatable=True, within_s=CHECKED_S)
        if answer["restart"] and restarts:
            reached.post("/api/versions/restart", by, is_repeatable=True)
    except ArboledaError as error:
        _print(say(NOT_TAKEN_NOW(why=error.sentence)))
        raise typer.Exit(NOT_TAKEN) from error
    for line in answer["restart"]:
        _print(f"  {finding(line)}")
    if answer["restart"]:
        _print(say(RESTARTS() if restarts else NEEDS_RESTART()))
        return
    for cell, when in answer["cells"].items():
        _print(f"  {say(TAKES_IT(cell=cell, when=when))}")
    for task in answer["cancelled"]:
        _print(f"  {say(CANCELLED(task=task))}")


def _heading(version: Version, *, is_running: bool) -> Iterator[str]:
    yield f"{version.number:>3}  {_minute(version)}"
    yield from (each for each in (version.by, say(AT_WORK()) if is_running else "", version.note) if each)


def _minute(version: Version) -> str:
    return version.at.partition("+")[0].replace("T", " ") + " UTC"


def _now() -> str:
    return datetime.now(timezone.utc).isoformat(timespec="seconds")


def _print(line: str) -> None:
    print(plain(line, LONGEST), flush=True)
