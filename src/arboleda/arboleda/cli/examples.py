"""The command `arboleda examples`: whole cells to read, to run and to change."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from arboleda.model.errors import ConfigError
from arboleda.model.outside import quoted
from arboleda.model.sentence import Phrase
from arboleda.plant_file.examples import PLANT, about, found, texts
from arboleda.runtime import invocation

from .language import allowed, say
from .new import WROTE, write_files

HAVE_ONE = Phrase("cli.examples.have_one", "To have one in a folder of its own: {command} examples NAME")
NO_EXAMPLE = Phrase("cli.examples.none", "there is no example {name}; {others}")
RUN_IT = Phrase("cli.examples.run_it", "On virtual devices, with a page:")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(examples)


def examples(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="The example to write; without it all are listed.")
    ] = "",
    folder: Annotated[
        Path | None, typer.Argument(metavar="FOLDER", help="Where to write it. [default: ./NAME]")
    ] = None,
) -> None:
    """List the examples that come with Arboleda, or write one to a folder, to be changed."""
    known = found()
    if not name:
        for each, source in known.items():
            typer.echo(f"{each:17}{about(source)}")
        typer.echo(f"\n{say(HAVE_ONE(command=invocation.command()))}")
        return
    if name not in known:
        raise ConfigError((say(NO_EXAMPLE(name=quoted(name), others=allowed(name, known))),))
    written = write_files(folder or Path(name), texts(known[name]))
    for file in written:
        typer.echo(say(WROTE(file=str(file))))
    plant = next(shlex.quote(str(file)) for file in written if file.name == PLANT)
    typer.echo(f"\n{say(RUN_IT())}\n  {invocation.command()} up --plant {plant}")
