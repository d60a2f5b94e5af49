"""The command `arboleda examples`: whole cells to read, to run and to change."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from arboleda.model.sentence import Phrase
from arboleda.plant_file.examples import about, folders
from arboleda.runtime import invocation

from .language import say
from .new import copy_example

HAVE_ONE = Phrase("cli.examples.have_one", "To have one in a folder of its own: {command} examples NAME")


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
    if not name:
        for each, source in folders().items():
            typer.echo(f"{each:17}{about(source)}")
        typer.echo(f"\n{say(HAVE_ONE(command=invocation.command()))}")
        return
    copy_example(name, folder or Path(name))
