"""`arboleda token`: show the tokens of a plant, or make new ones."""

from __future__ import annotations

from typing import Annotated

import typer

from arboleda.model.errors import StartError
from arboleda.model.sentence import Phrase
from arboleda.runtime import tokens
from arboleda.runtime.state import LOCK
from arboleda.web.access.auth import Role

from .language import say
from .plant_options import RunningPlant, StateFolder, located

NO_PLANT = Phrase(
    "cli.token.no_plant", "No plant keeps its state in {folder}; open one by `arboleda up --host ADDRESS`."
)
KEPT_IN = Phrase("cli.token.kept_in", "kept in {file}")

New = Annotated[bool, typer.Option("--new", help="Make a new one first; the old one is void at once.")]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(token)


def token(
    role: Annotated[
        Role | None, typer.Argument(metavar="ROLE", help="Whose token. [default: all]", show_default=False)
    ] = None,
    new: New = False,
    plant: RunningPlant = None,
    state: StateFolder = None,
) -> None:
    """Show the token of viewers, operators or assistants of a plant open to a network (`up --host`)."""
    where = located(plant, state)
    if not (where / LOCK).exists():
        raise StartError(NO_PLANT(folder=str(where)))
    if new:
        tokens.renew(where, [role] if role else list(Role))
    known = tokens.read(where)
    if role is not None:
        print(known[role])
        return
    for each, value in known.items():
        print(f"{each.value:9} {value}")
    print(say(KEPT_IN(file=str(where / tokens.TOKENS))))
