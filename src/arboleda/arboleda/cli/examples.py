"""The command `arboleda examples`: whole cells to read, to run and to change."""

from __future__ import annotations

import shlex
from importlib.resources import files
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from arboleda.model.errors import ConfigError
from arboleda.model.outside import among, quoted
from arboleda.runtime import invocation

from .new import write_files

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

PLANT = "plant.yaml"


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
        typer.echo(f"\nTo have one in a folder of its own: {invocation.command()} examples NAME")
        return
    if name not in known:
        raise ConfigError((f"there is no example {quoted(name)}; {among(name, known)}",))
    written = write_files(folder or Path(name), texts(known[name]))
    for file in written:
        typer.echo(f"wrote {file}")
    plant = next(shlex.quote(str(file)) for file in written if file.name == PLANT)
    typer.echo(f"\nOn virtual devices, with a page:\n  {invocation.command()} up --plant {plant}")


def found() -> dict[str, Traversable]:
    """The folder of each example, by its name."""
    folders = files("arboleda").joinpath("examples").iterdir()
    return {each.name: each for each in sorted(folders, key=_name) if each.joinpath(PLANT).is_file()}


def about(example: Traversable) -> str:
    """The comment at the beginning of an example's plant file."""
    lines = example.joinpath(PLANT).read_text("utf-8").splitlines()
    return " ".join(line.lstrip("# ") for line in takewhile(lambda line: line.startswith("#"), lines))


def texts(folder: Traversable, under: str = "") -> dict[str, str]:
    """The contents of an example's files, by their paths in it."""
    held: dict[str, str] = {}
    for each in sorted(folder.iterdir(), key=_name):
        if each.is_file():
            held[under + each.name] = each.read_text("utf-8")
        elif each.name != "__pycache__":
            held |= texts(each, f"{under}{each.name}/")
    return held


def _name(entry: Traversable) -> str:
    return entry.name
