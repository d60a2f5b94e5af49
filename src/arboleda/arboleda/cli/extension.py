"""`arboleda extension`: the installed packages that add something, which of them are off, and a new one."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from arboleda.host.distributions import OFF, Added, added, called, kept_off, off_file
from arboleda.model.errors import ArboledaError, ConfigError, StartError
from arboleda.model.outside import quoted
from arboleda.model.sentence import Phrase, Value
from arboleda.plant_file.examples import NAMED
from arboleda.plant_file.shapes import NAME_RULE as RULE
from arboleda.plant_file.shapes import is_name
from arboleda.runtime import invocation
from arboleda.runtime.state import replace_file

from .language import allowed, finding, say
from .new import NOT_WRITTEN, WROTE, write_started
from .overview import WholeSentences

cli = typer.Typer(
    cls=WholeSentences,
    help="Installed packages that add to Arboleda: which there are, which are off, and a new one.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
NONE = Phrase("cli.extension.none", "no package is installed that adds anything")
LINE = Phrase("cli.extension.line", "{name} {version} ({api}): {adds}")
IN_PLANT_FILE = Phrase("cli.extension.in_plant_file", "in a plant file: extensions: {{{name}: ...}}")
IS_OFF = Phrase("cli.extension.is_off", "off: {command} extension on {name}")
NO_PACKAGE = Phrase("cli.extension.no_package", "there is no package {name}; {others}")
WENT_OFF = Phrase(
    "cli.extension.went_off",
    "{name} is off for every plant of this user, from the next start on. To take it back: "
    "{command} extension on {name}",
)
WENT_ON = Phrase("cli.extension.went_on", "{name} is on again, from the next start of a plant on")
BY_VARIABLE = Phrase("cli.extension.by_variable", "{name} is off by {variable}, which this does not change")
WORDS = {
    "commands": Phrase("cli.extension.commands", "commands"),
    "languages": Phrase("cli.extension.languages", "languages"),
    "page": Phrase("cli.extension.page", "the page"),
    "parts": Phrase("cli.extension.parts", "parts"),
    "routes": Phrase("cli.extension.routes", "routes"),
}
THINGS = {
    "drivers": Phrase("cli.extension.drivers", "drivers {names}"),
    "kinds": Phrase("cli.extension.kinds", "kinds {names}"),
    "stores": Phrase("cli.extension.stores", "stores {names}"),
}
OF_A_PLANT = ("page", "parts", "routes")  # what a plant file can set, or leave out
WRITTEN = {
    "extension.toml": "pyproject.toml",
    "extension.py": f"{NAMED}.py",
    "tests_of_extension.py": f"test_{NAMED}.py",
}
NAME_RULE = Phrase("cli.extension.name_rule", f"{RULE}, and no module may have it")
BAD_NAME = Phrase("cli.extension.bad_name", "{name} cannot be the name of a package; it must be {rule}")
NEXT = Phrase(
    "cli.extension.next",
    """
Install it beside Arboleda; what it counts is shown by a plant that starts after that, at /api/{name}:
  {install} -e {folder}
  {command} up
Its test; the first line once, for pytest has to be beside Arboleda:
  {install} pytest
  {python} -m pytest {folder}

A plant file may set what Settings in {name}.py has: extensions: {{{name}: {{counts: failed}}}}""",
)
Name = typer.Argument(metavar="NAME", help="A package, as `arboleda extension list` names it.")


@cli.command("list")
def list_extensions() -> None:
    """List the installed packages that add something: what each adds, and whether it is off or left out."""
    rows = added()
    for each in rows:
        print("\n".join(_lines(each)))
    if not rows:
        print(say(NONE()))


@cli.command()
def off(name: Annotated[str, Name]) -> None:
    """Leave a package out of every plant of this user, from the next start on; nothing of it is imported.

    A plant file leaves it out of one plant: `extensions: {NAME: off}`.
    """
    found = _found(name)
    _keep({*kept_off(), called(found.name)})
    print(say(WENT_OFF(name=found.name, command=invocation.command())))


@cli.command()
def on(name: Annotated[str, Name]) -> None:
    """Take back what `arboleda extension off` did."""
    found = _found(name)
    _keep(kept_off() - found.names)
    still_off = next(each for each in added() if each.name == found.name).is_off
    print(say(BY_VARIABLE(name=found.name, variable=OFF) if still_off else WENT_ON(name=found.name)))


@cli.command()
def new(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", help="The folder to write; its name is that of the package.")
    ],
) -> None:
    """Write a package of your own: a part that counts tasks, with settings, a table, a route and a test."""
    name = folder.resolve().name
    if not is_name(name) or find_spec(name) is not None:
        raise ConfigError((say(BAD_NAME(name=quoted(name), rule=NAME_RULE())),))
    for file in write_started(folder, WRITTEN):
        typer.echo(say(WROTE(file=str(file))))
    command, python, install = invocation.command(), invocation.python(), invocation.pip_install()
    where = shlex.quote(str(folder))
    typer.echo(say(NEXT(command=command, python=python, install=install, name=name, folder=where)))


def add_to(parent: typer.Typer) -> None:
    """Add the group."""
    parent.add_typer(cli, name="extension")


def _found(name: str) -> Added:
    """The package of that name; ArboledaError where there is none."""
    rows = added()
    for each in rows:
        if called(name) in each.names:
            return each
    raise ArboledaError(NO_PACKAGE(name=quoted(name), others=allowed(name, [each.name for each in rows])))


def _keep(names: Collection[str]) -> None:
    """Keep which packages are off; StartError if the machine refuses."""
    file = off_file()
    try:
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        replace_file(file, "".join(f"{each}\n" for each in sorted(names)))
    except OSError as error:
        raise StartError(NOT_WRITTEN(folder=str(file), error=str(error.strerror or error))) from error


def _lines(each: Added) -> Iterator[str]:
    numbers = ", ".join(each.adds.get("api", ()))
    api = f"API {numbers}" if numbers else ""
    yield say(LINE(name=each.name, version=each.version, api=api, adds=tuple(_adds(each))))
    if each.is_off:
        yield f"  {say(IS_OFF(name=each.name, command=invocation.command()))}"
    elif each.left_out:
        yield f"  {finding(each.left_out)}"
    else:
        here = {name.partition(".")[0] for group in OF_A_PLANT for name in each.adds.get(group, ())}
        yield from (f"  {say(IN_PLANT_FILE(name=name))}" for name in sorted(here))


def _adds(each: Added) -> Iterator[Value]:
    for group, names in sorted(each.adds.items()):
        if group in THINGS:
            yield THINGS[group](names=names)
        elif group != "api":
            yield WORDS[group]() if group in WORDS else group
