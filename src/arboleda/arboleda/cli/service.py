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

from arboleda.host.users import home_of
from arboleda.model.errors import StartError
from arboleda.model.outside import plain
from arboleda.plant_file import loader
from arboleda.runtime.state import default_state

from .overview import WholeSentences
from .plant_options import PlantFile, StateFolder
from .service_unit import unit

TIMEOUT_S = 100.0  # longer than a unit may take to end
HELP = "Have systemd run the plant: from the start of the machine on, and again where it breaks down."
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
    print(f"{name} runs, and starts with {'the machine' if system else 'your login'}: {manager.path(name)}")
    if not system:
        print(f"To have it run while you are not logged in: loginctl enable-linger {getpass.getuser()}")


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
    print(f"{name} is no service any more; its state directory is as it was")


class Manager:
    """Manager: systemd, that of the machine or that of a user; StartError if it refuses."""

    def __init__(self, system: bool) -> None:
        if shutil.which("systemctl") is None:
            raise StartError(
                "this machine has no systemd (systemctl is not there); let what starts its programs call "
                "`arboleda up`"
            )
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
            other = "without --system" if self._system else "with --system"
            raise StartError(
                f"{plant} is no service here ({self.path(plant)} is not there); it may be one {other}, "
                "or type `arboleda service install`"
            )

    def run(self, *words: str, quiet: bool = False) -> subprocess.CompletedProcess[str]:
        """Run systemctl with these words; its output is printed, or kept if `quiet`."""
        whose = [] if self._system else ["--user"]
        try:
            return subprocess.run(
                ["systemctl", *whose, *words], capture_output=quiet, text=True, timeout=TIMEOUT_S, check=False
            )
        except subprocess.TimeoutExpired as error:
            raise StartError(f"systemctl {' '.join(words)} has not ended after {TIMEOUT_S:.0f} s") from error

    def _ask(self, *words: str) -> None:
        ran = self.run(*words, quiet=True)
        if ran.returncode:
            trouble = (ran.stderr.strip() or f"exit status {ran.returncode}").splitlines()[0]
            raise StartError(f"systemd does not do it (systemctl {' '.join(words)}): {plain(trouble)}")

    def _write(self, path: Path, text: str | None) -> None:
        try:
            if text is None:
                path.unlink(missing_ok=True)
                return
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        except OSError as error:
            rights = "; type sudo before it" if self._system and isinstance(error, PermissionError) else ""
            raise StartError(f"{path} cannot be written: {error.strerror}{rights}") from error

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
        raise typer.BadParameter(f"{named[0]} stands before --: `arboleda service install {named[0]} ...`")
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
        raise StartError(f"{folder} cannot be made: {error.strerror}") from error


def _program() -> Path:
    """The absolute path of the command itself."""
    beside = Path(sys.executable).with_name("arboleda")
    found = beside if beside.exists() else shutil.which("arboleda")
    if found is None:
        raise StartError(f"there is no command arboleda beside {sys.executable}; install it with pip first")
    return Path(found).absolute()


def _state_of(plant: str, user: str | None) -> Path:
    """The state directory of a plant of this user."""
    if user is None:
        return default_state(plant)
    home = home_of(user)
    if home is None:
        raise StartError(f"this machine has no user {plain(user)}; name one with --user")
    return home / ".local/state/arboleda" / plant


def add_to(parent: typer.Typer) -> None:
    """Add the group."""
    parent.add_typer(cli, name="service")
