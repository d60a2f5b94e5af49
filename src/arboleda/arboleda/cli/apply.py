"""The commands `arboleda apply` and `arboleda versions`: what was changed is shown, put to work and kept."""

from __future__ import annotations

import getpass
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timezone
from pathlib import Path
from typing import Annotated

import typer

from arboleda.model.errors import ArboledaError, ConfigError
from arboleda.model.outside import plain
from arboleda.plant_file import draft_check, loader, plant_check
from arboleda.plant_file.changes import Change, changes
from arboleda.plant_file.restart import needing_restart
from arboleda.plant_file.versions import Version, Versions, version_of, whole
from arboleda.runtime import at_work
from arboleda.runtime.state import Running, default_state, find_running

from .plant_options import PlantFile, StateFolder, client

LONGEST = 500  # characters of a line
NOT_SHIPPED = (
    "the shipped plant cannot be changed: write one of your own with `arboleda new`, or copy its file, and"
    " name it with --plant"
)
NOT_TAKEN = 1
RESTART = (
    "the plant that runs goes on as it is, and has it from its next start on; so has the next leader of"
    " two, as after `arboleda handover`; `--restart`, or the page, has it restart once all its cells rest"
)
RESTARTS = "the plant that runs restarts with it once all its cells rest; until then no further task begins"
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
Yes = Annotated[bool, typer.Option("--yes", help="Do not ask.")]


@dataclass(frozen=True, kw_only=True)
class _Base:
    """Basis of a comparison: an earlier version, None for nothing, and the process that runs the plant."""

    version: Version | None
    running: Running | None

    @property
    def name(self) -> str:
        if self.version is None:
            return "nothing was kept before; this is the first version"
        kept = f"version {self.version.number} of {_minute(self.version)}"
        started = f"what the plant was started with at {_minute(self.version)}"
        return kept if self.version.number else started


def apply(
    plant: PlantFile = None,
    back: Back = None,
    note: Note = "",
    restart: Restart = False,
    yes: Yes = False,
    state: StateFolder = None,
) -> None:
    """Check a plant file and all that it uses, show what is another than what is at work, and put it to work.

    Versions are kept in the folder .arboleda beside the plant file. A plant that runs takes the version: each
    cell once its task has ended. What needs a restart is said before anything is done. Exit status: 0 kept,
    or nothing to keep; 1 you said no, or the plant that runs has not taken it; 2 the check refuses it, and
    nothing was changed.
    """
    file = _named(plant)
    kept = Versions(file)
    kept.go_on()
    wanted = _on_disk(file) if back is None else _checked(file, kept, kept.find(back))
    base = _base(wanted.plant_name, kept, state)
    lines = tuple(each.words for each in _told(base.version, wanted))
    if base.version is not None and not lines:
        if back is not None and not kept.is_in_place(wanted.version):
            _ask("Bring its files back?", yes=yes)
            kept.bring_back(wanted.version)
        _print(f"{file}: as in {base.name}; there is nothing to put to work")
        return
    _print(f"{file}: compared with {base.name}:" if base.version else f"{file}: {base.name}")
    for line in lines:
        _print(f"  {line}")
    if base.running is not None and (needing := needing_restart(_told(base.version, wanted))):
        _print("this needs a restart, or a handover; until then the plant that runs goes on as it is:")
        for line in needing:
            _print(f"  {line}")
    _ask("Put this to work?", yes=yes)
    if back is not None:
        kept.bring_back(wanted.version)
        wanted = replace(wanted, version=version_of(loader.load_with_files(file)[1], at=_now()))
    fresh = replace(wanted.version, changes=lines, note=note or (f"version {back} again" if back else ""))
    number = _keep(kept, base, fresh)
    if base.running is None:
        _print(f"version {number} is kept; the next start of the plant has it")
        return
    _print(f"version {number} is kept")
    _put_to_work(number, plant, state, restarts=restart)


def versions(plant: PlantFile = None, state: StateFolder = None) -> None:
    """List the versions of a plant file that were put to work, oldest first, with what each has changed.

    `arboleda apply --back N` brings one back.
    """
    file = _named(plant)
    kept = Versions(file)
    base = _base(loader.load(file, recipes=False).name, kept, state)
    runs = base.version.digest if base.running and base.version else ""
    known = kept.all()
    if not known:
        _print(f"{file}: no version is kept; `arboleda apply` keeps one")
    for each in known:
        _print("  ".join(_heading(each, is_running=each.digest == runs)))
        for line in each.changes:
            _print(f"  {line}")


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
        raise ConfigError((NOT_SHIPPED,))
    return plant


def _on_disk(file: Path) -> _Wanted:
    """The files as they are now; ConfigError with every problem. Prints what `check` warns of."""
    model, files = loader.load_with_files(file)
    for warning in plant_check.warnings(model):
        _print(f"{file}: warning: {warning}")
    return _Wanted(version=version_of(files, at=_now()), plant_name=model.name)


def _checked(file: Path, kept: Versions, version: Version) -> _Wanted:
    """A version that is to come back; ConfigError where it is no plant beside the other files of today."""
    found = draft_check.check(version.files, file)
    if found.plant is None:
        raise ConfigError((f"version {version.number} cannot be brought back:", *found.problems))
    for warning in found.warnings:
        _print(f"{file}: warning: {warning}")
    for name in kept.others_now(version):
        _print(f"{name}: another file than with version {version.number}; it stays as it is")
    return _Wanted(version=version, plant_name=found.plant.name, comes_back=True)


def _base(plant_name: str, kept: Versions, state: Path | None) -> _Base:
    """The version at work in the plant that runs; where none runs, the one that was kept last."""
    where = state or default_state(plant_name)
    running, started, last = find_running(where), at_work.known(where), kept.last()
    if running is not None and started is not None:
        same = next((each for each in reversed(kept.all()) if each.digest == started.digest), None)
        return _Base(version=same or started, running=running)
    return _Base(version=last or started, running=running)


def _told(base: Version | None, wanted: _Wanted) -> Sequence[Change]:
    """Changes that a version makes to what is at work, of which there may be nothing."""
    if base is None:
        return ()
    sides = [base.files, wanted.version.files] if wanted.comes_back else [whole(base), whole(wanted.version)]
    return changes(*sides)


def _keep(kept: Versions, base: _Base, version: Version) -> int:
    """Keep a version, before it what is at work if no version has that; its number."""
    before = base.version
    if before is not None and not before.number:
        kept.keep(replace(before, note="as the plant was started"))
    last = kept.last()
    if last is not None and last.digest == version.digest:  # kept before, and not at work yet
        return last.number
    return kept.keep(replace(version, by=getpass.getuser())).number


def _put_to_work(number: int, plant: Path | None, state: Path | None, *, restarts: bool) -> None:
    """Have the plant that runs take a version, and print when each cell does; status 1 if it does not."""
    reached = client(plant, state)
    try:
        answer = reached.put_to_work(number, getpass.getuser())
        if answer["restart"] and restarts:
            reached.restart_at_rest(getpass.getuser())
    except ArboledaError as error:
        _print(f"the plant that runs goes on as it is, and has it from its next start on: {error}")
        raise typer.Exit(NOT_TAKEN) from error
    for line in answer["restart"]:
        _print(f"  {line}")
    if answer["restart"]:
        _print(RESTARTS if restarts else RESTART)
        return
    for cell, when in answer["cells"].items():
        _print(f"  {cell} takes it {when}")
    for task in answer["cancelled"]:
        _print(f"  task {task} waited, and is cancelled: the plant does not take it any more")


def _heading(version: Version, *, is_running: bool) -> Iterator[str]:
    yield f"{version.number:>3}  {_minute(version)}"
    yield from (each for each in (version.by, "at work" if is_running else "", version.note) if each)


def _minute(version: Version) -> str:
    return version.at.partition("+")[0].replace("T", " ") + " UTC"


def _now() -> str:
    return datetime.now(timezone.utc).isoformat(timespec="seconds")


def _print(line: str) -> None:
    print(plain(line, LONGEST), flush=True)
