"""`arboleda class`: a folder with a plant for each student, tokens, and what shows all on one page."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated
from urllib.parse import urlsplit

import typer

from arboleda.cli.new import BAD_NAME, NAME_RULE
from arboleda.drivers import quoted
from arboleda.extension import ConfigError, Phrase, StartError, say
from arboleda.plant_file import examples
from arboleda.plant_file.shapes import is_plant_name
from arboleda.runtime import invocation
from arboleda.web.access.names import other_address, public_origin

if TYPE_CHECKING:
    from .student import Student

TOKENS, LAST_PORT = "tokens", 65535
TWICE = Phrase("cli.class.twice", "{name} is there {times} times; each student needs another name")
NO_PLANT = Phrase(
    "cli.class.no_plant", "{folder} is there already and has no {plant}; choose another name or folder"
)
TOO_MANY = Phrase("cli.class.too_many", "from port {port} on there are no ports for {count} students")
NO_NETWORK = Phrase(
    "cli.class.no_network", "this machine has no address on a network; say which it will have: --address"
)
NOT_WRITTEN = Phrase("cli.class.not_written", "{file} cannot be written: {error}")
STUDENTS = Phrase("cli.class.students", "What each student opens, and types to log in:")
START = Phrase("cli.class.start", "What starts their plants, each in a terminal:")
ALL = Phrase("cli.class.all", "All on one page, for you; the tokens are in {file}:")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command("class")(write_class)


def write_class(
    names: Annotated[
        list[str], typer.Argument(metavar="NAME", help="A student; the name is that of the plant.")
    ],
    folder: Annotated[
        Path, typer.Option("--folder", metavar="FOLDER", help="Where to write the class.")
    ] = Path("class"),
    address: Annotated[
        str,
        typer.Option(
            metavar="ADDRESS",
            help="This machine, as students reach it. [default: its address on the network]",
            show_default=False,
        ),
    ] = "",
    port: Annotated[
        int, typer.Option(metavar="N", min=1, max=LAST_PORT, help="The port of the first student's page.")
    ] = 8081,
) -> None:
    """Write a plant for each student, with tokens, and say what each student opens.

    What is there already stays as it is: called again with more names, it adds these.
    """
    from arboleda.runtime.endpoints import tokens_of

    from .student import note, written

    problems = tuple(_problems(names, folder, port))
    if problems:
        raise ConfigError(problems)
    here = address or other_address()
    if not here:
        raise StartError(NO_NETWORK())
    origin, file = public_origin(f"http://{here}"), folder / TOKENS
    addresses = {token: url for url, token in (tokens_of(file) if file.exists() else {}).items()}
    students = written(folder, names, addresses, origin, port)
    try:
        note(file, students, addresses)
    except OSError as error:
        raise StartError(NOT_WRITTEN(file=str(file), error=str(error.strerror or error))) from error
    _tell(students, file)


def _problems(names: Sequence[str], folder: Path, port: int) -> Iterator[str]:
    """Mistakes in the names and in the places for their plants, each in a sentence."""
    for name, times in Counter(names).items():
        if not is_plant_name(name):
            yield say(BAD_NAME(name=quoted(name), rule=NAME_RULE()))
        elif times > 1:
            yield say(TWICE(name=name, times=times))
        elif (folder / name).exists() and not (folder / name / examples.PLANT).is_file():
            yield say(NO_PLANT(folder=str(folder / name), plant=examples.PLANT))
    if port + len(names) - 1 > LAST_PORT:
        yield say(TOO_MANY(port=port, count=len(names)))


def _tell(students: Sequence[Student], file: Path) -> None:
    """Print what students open, and what the teacher types."""
    width, command = max(len(each.name) for each in students), invocation.command()
    typer.echo(say(STUDENTS()))
    for each in students:
        typer.echo(f"  {each.name:{width}}  {each.address}  {each.operator}")
    typer.echo(f"\n{say(START())}")
    for each in students:
        places = ["--plant", str(each.plant), "--state", str(each.state)]
        reached = ["--host", "0.0.0.0", "--port", str(urlsplit(each.address).port)]
        typer.echo(f"  {command} up --no-ros {shlex.join([*reached, *places])}")
    typer.echo(f"\n{say(ALL(file=str(file)))}")
    shown = shlex.join([*(each.address for each in students), "--tokens", str(file)])
    typer.echo(f"  {command} site {shown}")
