"""The command `arboleda new`: a folder with a plant of one's own that runs."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Annotated

import typer

from arboleda.model.errors import ConfigError, StartError
from arboleda.model.outside import quoted
from arboleda.model.sentence import Phrase
from arboleda.plant_file.examples import NAMED, PLANT, folders
from arboleda.plant_file.examples import texts as texts_of
from arboleda.plant_file.shapes import PLANT_NAME_RULE, is_plant_name
from arboleda.runtime import invocation

from .language import allowed, help_words, say

# by what they are called here; pytest must not take the tests of the new plant for tests of Arboleda
WRITTEN = {"plant.yaml": "plant.yaml", "recipes.py": "recipes.py", "tests_of_plant.py": "test_plant.py"}
WROTE = Phrase("cli.wrote", "wrote {file}")
NAME_RULE = Phrase("cli.new.name_rule", PLANT_NAME_RULE)
BAD_NAME = Phrase("cli.new.bad_name", "{name} cannot be the name of a plant; it must be {rule}")
IS_THERE = Phrase("cli.new.is_there", "{file} is there already; nothing was written. Choose another folder")
NOT_WRITTEN = Phrase("cli.new.not_written", "{folder} cannot be written: {error}")
NEXT = Phrase(
    "cli.new.next",
    """
What is wrong with it, line by line:
  {command} check {plant}
On virtual devices, with a page:
  {command} up "cell press feed 3" --plant {plant}
With faults; the first line once, for pytest has to be beside Arboleda:
  {install} pytest
  {python} -m pytest {folder}

What the devices can do is in plant.yaml, what they do together in recipes.py. Change them, check again.""",
)
NO_EXAMPLE = Phrase("cli.examples.none", "there is no example {name}; {others}")
RUN_IT = Phrase("cli.examples.run_it", "On virtual devices, with a page:")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(new)


def new(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", help="The folder to write; its name is that of the plant.")
    ],
    like: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help="Write an example of `arboleda examples` instead, with the names that it has.",
            show_default=False,
        ),
    ] = "",
) -> None:
    """Write a plant of your own: an arm, a device, a recipe and a test, in a folder of its own."""
    if like:
        copy_example(like, folder)
        return
    written = write(folder)
    command, plant = invocation.command(), shlex.quote(str(written[0]))
    for file in written:
        typer.echo(say(WROTE(file=str(file))))
    python, named = invocation.python(), shlex.quote(str(folder))
    install = invocation.pip_install()
    typer.echo(say(NEXT(command=command, plant=plant, python=python, install=install, folder=named)))


def copy_example(name: str, folder: Path) -> None:
    """Write an example to a folder, and say how to start it; ConfigError where there is no such example."""
    known = folders()
    if name not in known:
        raise ConfigError((say(NO_EXAMPLE(name=quoted(name), others=allowed(name, known))),))
    written = write_files(folder, texts_of(known[name]))
    for file in written:
        typer.echo(say(WROTE(file=str(file))))
    plant = next(shlex.quote(str(file)) for file in written if file.name == PLANT)
    typer.echo(f"\n{say(RUN_IT())}\n  {invocation.command()} up --plant {plant}")


def write(folder: Path) -> list[Path]:
    """The files of a new plant; errors are those of `write_files`, and ConfigError for a bad name."""
    name = folder.resolve().name
    if not is_plant_name(name):
        raise ConfigError((say(BAD_NAME(name=quoted(name), rule=NAME_RULE())),))
    return write_started(folder, WRITTEN)


def write_started(folder: Path, written: Mapping[str, str]) -> list[Path]:
    """Write files of the starter, by what they are called there; NAMED stands for the name of the folder."""
    starter, name = files("arboleda").joinpath("starter"), folder.resolve().name
    texts = {called: starter.joinpath(source).read_text("utf-8") for source, called in written.items()}
    return write_files(
        folder,
        {called.replace(NAMED, name): _told(text).replace(NAMED, name) for called, text in texts.items()},
    )


def _told(text: str) -> str:
    """A file of a new plant with its comments in this language."""
    for english, other in help_words("starter").items():
        text = text.replace(english, other)
    return text


def write_files(folder: Path, texts: Mapping[str, str]) -> list[Path]:
    """Write the files of a folder, by their paths in it; ConfigError, and nothing written, if one exists
    already.

    StartError if the machine refuses.
    """
    targets = {folder / called: text for called, text in texts.items()}
    there = next((each for each in targets if each.exists()), None)
    if there is not None:
        raise ConfigError((say(IS_THERE(file=str(there))),))
    try:
        for target, text in targets.items():
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, "utf-8")
    except OSError as error:
        raise StartError(NOT_WRITTEN(folder=str(folder), error=str(error.strerror or error))) from error
    return list(targets)
