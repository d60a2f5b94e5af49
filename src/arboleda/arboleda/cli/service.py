"""`arboleda service`: a plant that starts with the machine, under systemd."""

from __future__ import annotations

import getpass
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from arboleda.host.machine import home_of
from arboleda.model.errors import StartError
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase
from arboleda.plant_file import loader
from arboleda.runtime.state import default_state

from .language import say
from .overview import WholeSentences
from .plant_options import PlantFile, StateFolder
from .service_unit import unit

TIMEOUT_S = 100.0  # longer than a unit may take to end
HELP = "Have systemd run the plant: from the start of the machine on, and again where it breaks down."
RUNS_FROM_LOGIN = Phrase("cli.service.runs_from_login", "{plant} runs, and starts with your login: {unit}")
RUNS_FROM_START = Phrase("cli.service.runs_from_start", "{plant} runs, and starts with the machine: {unit}")
LINGER = Phrase(
    "cli.service.linger", "To have it run while you are not logged in: loginctl enable-linger {user}"
)
REMOVED = Phrase("cli.service.removed", "{plant} is no service any more; its state directory is as it was")
NO_SYSTEMD = Phrase(
    "cli.service.no_systemd",
    "this machine has no systemd (systemctl is not there); let what starts its programs call `arboleda up`",
)
NO_SERVICE = Phrase(
    "cli.service.no_service",
    "{plant} is no service here ({unit} is not there); it may be one with --system, "
    "or type `arboleda service install`",
)
NO_SERVICE_OF_SYSTEM = Phrase(
    "cli.service.no_service_of_system",
    "{plant} is no service here ({unit} is not there); it may be one without --system, "
    "or type `arboleda service install`",
)
NOT_ENDED = Phrase("cli.service.not_ended", "systemctl {words} has not ended after {seconds:.0f} s")
REFUSED = Phrase("cli.service.refused", "systemd does not do it (systemctl {words}): {why}")
EXIT_STATUS = Phrase("cli.service.exit_status", "exit status {status}")
NOT_WRITTEN = Phrase("cli.service.not_written", "{path} cannot be written: {why}")
NO_RIGHTS = Phrase("cli.service.no_rights", "{path} cannot be written: {why}; type sudo before it")
BEFORE_DASHES = Phrase(
    "cli.service.before_dashes", "{option} stands before --: `arboleda service install {option} ...`"
)
NOT_MADE = Phrase("cli.service.not_made", "{folder} cannot be made: {why}")
NO_COMMAND = Phrase(
    "cli.service.no_command", "there is no command arboleda beside {python}; install it with pip first"
)
NO_USER = Phrase("cli.service.no_user", "this machine has no user {user}; name one with --user")
cli = typer.Typer(cls=WholeSentences, help=HELP, no_args_is_help=True, rich_markup_mode=None)

System = Annotated[
    bool,
    typer.Option("--system", help="For the whole machine, as root; else for you alone, from your login on."),
]
User = Annotated[
    str | None,
    typer.Option(metavar="NAME", help="With --system: whose plant it is. [default: who called sudo]"),
]


@cli.command(context_settings={"ignore_unknown_options": True})
def install(
    context: typer.Context,
    words: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="-- OPTIONS OF up", help="How `arboleda up` is to be called, e.g. -- --boards real."
        ),
    ] = None,
    plant: PlantFile = None,
    state: StateFolder = None,
    system: System = False,
    user: User = None,
    show: Annotated[bool, typer.Option("--print", help="Print the unit and change nothing.")] = False,
) -> None:
    """Write the unit of a plant, start it, and have it start with the machine.

    Exit status: 0 it runs, 1 it could not be installed, and nothing has changed; 2 bad input.
    """
    options = list(words or [])
    _check_options(context, options)
    name = loader.load(plant).name
    who = (user or os.environ.get("SUDO_USER") or getpass.getuser()) if system else None
    home = state.absolute() if state else _state_of(name, who)
    command = [str(_program()), "up", "--state", str(home), *options]
    if plant is not None:
        command[2:2] = ["--plant", str(plant.absolute())]
    text = unit(plant=name, command=command, state=home, user=who)
    if show:
        print(text, end="")
        return
    manager = Manager(system)
    _make(home, who)
    manager.install(name, text)
    print(say((RUNS_FROM_START if system else RUNS_FROM_LOGIN)(plant=name, unit=str(manager.path(name)))))
    if not system:
        print(say(LINGER(user=getpass.getuser())))


@cli.command()
def status(plant: PlantFile = None, system: System = False) -> None:
    """Say whether systemd runs the plant, since when, and what it said last.

    Exit status: 0 it runs, 1 it does not.
    """
    name = loader.load(plant, recipes=False).name
    manager = Manager(system)
    manager.refuse_missing(name)
    raise typer.Exit(
        0 if manager.run("status", "--no-pager", f"arboleda-{name}.service").returncode == 0 else 1
    )


@cli.command()
def remove(plant: PlantFile = None, system: System = False) -> None:
    """End the plant that systemd runs, and take its unit away; what the plant knows stays.

    Exit status: 0 removed, 1 there was none, or it could not be.
    """
    name = loader.load(plant, recipes=False).name
    manager = Manager(system)
    manager.refuse_missing(name)
    manager.remove(name)
    print(say(REMOVED(plant=name)))


class Manager:
    """Manager: systemd, that of the machine or that of a user; StartError if it refuses."""

    def __init__(self, system: bool) -> None:
        if shutil.which("systemctl") is None:
            raise StartError(NO_SYSTEMD())
        self._system = system
        self._units = Path("/etc/systemd/system" if system else Path.home() / ".config/systemd/user")

    def path(self, plant: str) -> Path:
        return self._units / f"arboleda-{plant}.service"

    def install(self, plant: str, text: str) -> None:
        """Write and start a unit, or replace it if there is one; if that fails, all is as it was."""
        path = self.path(plant)
        before = path.read_text() if path.exists() else None
        try:
            self._write(path, text)
            self._ask("daemon-reload")
            self._ask("enable", path.name)
            self._ask("restart", path.name)
        except StartError:
            self._undo(path, before)
            raise

    def remove(self, plant: str) -> None:
        path = self.path(plant)
        self._ask("disable", "--now", path.name)
        self._write(path, None)
        self._ask("daemon-reload")

    def refuse_missing(self, plant: str) -> None:
        if not self.path(plant).exists():
            missing = NO_SERVICE_OF_SYSTEM if self._system else NO_SERVICE
            raise StartError(missing(plant=plant, unit=str(self.path(plant))))

    def run(self, *words: str, quiet: bool = False) -> subprocess.CompletedProcess[str]:
        """Run systemctl with these words; its output is printed, or kept if `quiet`."""
        whose = [] if self._system else ["--user"]
        try:
            return subprocess.run(
                ["systemctl", *whose, *words], capture_output=quiet, text=True, timeout=TIMEOUT_S, check=False
            )
        except subprocess.TimeoutExpired as error:
            raise StartError(NOT_ENDED(words=" ".join(words), seconds=TIMEOUT_S)) from error

    def _ask(self, *words: str) -> None:
        ran = self.run(*words, quiet=True)
        if ran.returncode:
            trouble = ran.stderr.strip().splitlines()
            why = plain(trouble[0]) if trouble else EXIT_STATUS(status=ran.returncode)
            raise StartError(REFUSED(words=" ".join(words), why=why))

    def _write(self, path: Path, text: str | None) -> None:
        try:
            if text is None:
                path.unlink(missing_ok=True)
                return
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        except OSError as error:
            phrase = NO_RIGHTS if self._system and isinstance(error, PermissionError) else NOT_WRITTEN
            raise StartError(phrase(path=str(path), why=str(error.strerror))) from error

    def _undo(self, path: Path, before: str | None) -> None:
        if before is None:
            self.run("disable", "--now", path.name, quiet=True)
        self._write(path, before)
        self.run("daemon-reload", quiet=True)
        if before is not None:
            self.run("restart", path.name, quiet=True)


def _check_options(context: typer.Context, words: Sequence[str]) -> None:
    """Refuse bad options of `up` now, not when systemd starts it at night."""
    group = context.find_root().command
    up = group.get_command(context, "up")  # type: ignore[attr-defined]
    named = [each for each in ("--plant", "--state") if any(word.split("=")[0] == each for word in words)]
    if named:
        raise typer.BadParameter(say(BEFORE_DASHES(option=named[0])))
    with up.make_context("up", list(words)):
        pass


def _make(folder: Path, owner: str | None) -> None:
    """Make a folder and the missing ones above it, as its owner would have made them."""
    missing = [each for each in (folder, *folder.parents) if not each.exists()]
    try:
        for each in reversed(missing):
            each.mkdir(mode=0o700)
            if owner is not None:
                shutil.chown(each, owner)
    except OSError as error:
        raise StartError(NOT_MADE(folder=str(folder), why=str(error.strerror))) from error


def _program() -> Path:
    """The absolute path of the command itself."""
    beside = Path(sys.executable).with_name("arboleda")
    found = beside if beside.exists() else shutil.which("arboleda")
    if found is None:
        raise StartError(NO_COMMAND(python=sys.executable))
    return Path(found).absolute()


def _state_of(plant: str, user: str | None) -> Path:
    """The state directory of a plant of this user."""
    if user is None:
        return default_state(plant)
    home = home_of(user)
    if home is None:
        raise StartError(NO_USER(user=plain(user)))
    return home / ".local/state/arboleda" / plant


def add_to(parent: typer.Typer) -> None:
    """Add the group."""
    parent.add_typer(cli, name="service")
