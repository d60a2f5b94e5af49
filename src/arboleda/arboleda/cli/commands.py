"""Commands of `arboleda`: the module that has each, which is loaded when the command is called, and its
sentence in the overview.

A package adds its own: its entry point of the group `arboleda.commands` names a mapping from the name of each
command to its `Command`. No package is loaded for a command of the runner: a stop waits for none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache, partial
from importlib import import_module
from traceback import extract_tb
from typing import Any, NamedTuple

import typer

from arboleda.host.packages import left_out, registered
from arboleda.host.pieces import LONGEST, RUNNER, Pieces, piece_of
from arboleda.model.errors import ArboledaError
from arboleda.model.outside import plain
from arboleda.model.packages import (
    BOARDS,
    CLASS,
    DRIVERS,
    FLEET,
    MAKE,
    MISSING,
    PROOFS,
    TREES,
    PackageMissing,
)
from arboleda.model.sentence import Phrase
from arboleda.model.verbs import Verb
from arboleda.views.verb_words import ABOUT

from .language import finding
from .loading import loading

GROUP = "arboleda.commands"
SAYS_WHY = typer.BadParameter.__mro__[2]  # what typer raises to end with a sentence
TOLD: tuple[type[BaseException], ...] = (ArboledaError, SAYS_WHY, typer.Exit, typer.Abort, BrokenPipeError)
ADDS_NONE = Phrase("cli.commands.adds_none", "{module} adds no command {name}")
BROKE = Phrase("cli.commands.broke", "the command {name} of {package} broke: {why} ({file}, line {line})")
OF_PACKAGES = {  # extras of `arboleda`, by command
    "apply": MAKE,
    "class": CLASS,
    "conformance": BOARDS,
    "exercise": CLASS,
    "fault": PROOFS,
    "firmware-config": BOARDS,
    "handover": FLEET,
    "mcp": MAKE,
    "nodes": TREES,
    "oee": FLEET,
    "prove": PROOFS,
    "record replay": PROOFS,
    "record unlike": PROOFS,
    "report": PROOFS,
    "simulate": PROOFS,
    "site": FLEET,
    "topics": DRIVERS,
    "virtual": DRIVERS,
}


class Command(NamedTuple):
    """Command: the module whose `add_to` adds it, and what it does in a sentence.

    The command of a group is named with it, as `record replay`. A module without a dot is of this room.
    `section` is the heading of the overview under which a package has its command.
    """

    module: str
    brief: str
    section: str = "Make it yours"


BY_OPTION: Mapping[Verb, Verb] = {Verb.LOAD: Verb.UNLOAD, Verb.TEACH: Verb.AUTOMATIC}
"""The verb that an option of the command of another verb stands for."""
OURS: Mapping[str, Command] = {
    "up": Command(
        "up", "Run the plant until Ctrl-C, or until the tasks that are named have ended (`--once`)."
    ),
    "help": Command("topics", "List the commands of a topic, or explain a command."),
    "submit": Command(
        "submit", "Send a task to the plant that runs on this machine, or that another host leads."
    ),
    "status": Command(
        "status", "Show what the plant is doing that runs on this machine, or that another host leads."
    ),
    "token": Command(
        "token",
        "Show the token of viewers, operators or assistants of a plant open to a network (`up --host`).",
    ),
    "bench": Command(
        "bench", "Measure this machine: our figures beside the least that the same run can take."
    ),
    **{verb.value: Command("verbs", ABOUT[verb].brief) for verb in Verb if verb not in BY_OPTION.values()},
    "check": Command(
        "check",
        "Check a plant file, or behavior trees in the XML of BehaviorTree.CPP; every problem at "
        "once, each with its line.",
    ),
    "tree": Command("tree", "Draw the behavior tree of a recipe, or the one that runs."),
    "new": Command(
        "new", "Write a plant of your own: an arm, a device, a recipe and a test, in a folder of its own."
    ),
    "extension": Command(
        "extension", "Installed packages that add to Arboleda: which there are, which are off, and a new one."
    ),
    "examples": Command(
        "examples", "List the examples that come with Arboleda, or write one to a folder, to be changed."
    ),
    "tasks": Command(
        "tasks", "List tasks and their outcomes, also of earlier starts, whether the plant runs or not."
    ),
    "backup": Command("backup", "Copy the plant's memory to a file, while the plant runs or not."),
    "restore": Command("backup", "Put a backup in the place of the plant's memory; the plant must not run."),
    "record logs": Command(
        "logs", "Show what became of tasks and cells and what operators did, of all starts that are recorded."
    ),
    "urdf": Command("urdf", "Print a robot of the plant as URDF."),
    "service": Command(
        "service",
        "Have systemd run the plant: from the start of the machine on, and again where it breaks down.",
    ),
    "record": Command(
        "record", "The flight record of a plant: what went into its core and what came out, of every start."
    ),
}


@cache
def commands() -> Mapping[str, Command]:
    """The commands of Arboleda and of other packages, by name; of two with one name the first, ours before
    all."""
    found: dict[str, Command] = {}
    pieces = Pieces(str, _tell)
    tell_left_out()
    for each in registered(GROUP):
        with pieces.calling(piece_of(each, "the commands")):
            for name, command in each.load().items():
                if name in OURS or name in found:
                    whose = found[name].module.partition(".")[0] if name in found else RUNNER
                    pieces.leave_out_taken(piece_of(each, f"the command {name}"), whose)
                else:
                    found[name] = command
    return {**found, **OURS}


def tell_left_out() -> None:
    """Say which packages are left out whole."""
    for line in left_out():
        _tell(line)


def _tell(line: str) -> None:
    typer.echo(finding(line), err=True)


class LoadedCommands(Mapping[str, Any]):
    """Commands by name, of a `group` beside those that it has itself; the module of each is loaded when it is
    looked up.
    """

    def __init__(self, group: str = "", own: Mapping[str, Any] | None = None) -> None:
        self._before = f"{group} " if group else ""
        self._own = own or {}
        self._loaded: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name in self._own:
            return self._own[name]
        whole = f"{self._before}{name}"
        if whole not in self._loaded:
            group = whole.rpartition(" ")[0]
            added = _commands_of(_known(whole).module, whole)
            self._loaded |= {f"{group} {each}".lstrip(): command for each, command in added.items()}
        if whole not in self._loaded:
            raise ArboledaError(ADDS_NONE(module=_known(whole).module, name=whole))
        return self._loaded[whole]

    def __iter__(self) -> Iterator[str]:
        before = self._before
        named = (each.removeprefix(before) for each in commands() if each.startswith(before))
        return iter([*self._own, *(each for each in named if " " not in each)])

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, name: object) -> bool:
        whole = f"{self._before}{name}"
        return (
            name in self._own or any(whole in those for those in (OURS, OF_PACKAGES)) or whole in commands()
        )


def _known(name: str) -> Command:
    """A command; PackageMissing if its package is not installed, KeyError if there is no such command."""
    if name in OURS:
        return OURS[name]
    if name not in commands() and name in OF_PACKAGES:
        raise PackageMissing(MISSING(what=name, package=OF_PACKAGES[name]))
    return commands()[name]


def _commands_of(module: str, name: str) -> Mapping[str, Any]:
    """All commands that a module adds, asked for by the name of one."""
    cli = typer.Typer(add_completion=False, rich_markup_mode=None)
    cli.callback()(_nothing)  # typer makes a group only of what has one, or several commands
    with _sparing_people(module, name), loading():
        loaded = import_module(module if "." in module else f".{module}", __package__)
        loaded.add_to(cli)
    group: Any = typer.main.get_command(cli)
    for called, each in group.commands.items():
        if hasattr(each, "commands"):
            each.commands = LoadedCommands(called, each.commands)
        each.invoke = partial(_invoked, each.invoke, module, called)
    found: Mapping[str, Any] = group.commands
    return found


def _invoked(invoke: Callable[[Any], Any], module: str, name: str, context: Any) -> Any:
    with _sparing_people(module, name):
        return invoke(context)


@contextmanager
def _sparing_people(module: str, name: str) -> Iterator[None]:
    """Time in which a command runs; where one of a package breaks, a sentence says so, and where."""
    try:
        yield
    except TOLD:
        raise
    except Exception as error:
        if "." not in module:
            raise
        from arboleda.plant_file.python_uses import error_text  # no command waits for it that works

        *_, last = [each for each in extract_tb(error.__traceback__) if not each.filename.startswith("<")]
        package, why = module.partition(".")[0], plain(error_text(error), LONGEST)
        raise ArboledaError(
            BROKE(name=name, package=package, why=why, file=last.filename, line=last.lineno or 0)
        ) from error


def _nothing() -> None:
    pass
