"""`arboleda token`: show the tokens of a plant, or make new ones."""

from __future__ import annotations

from typing import Annotated

import typer

from arboleda.model.errors import StartError
from arboleda.runtime import tokens
from arboleda.runtime.state import LOCK
from arboleda.web.access.auth import Role

from .plant_options import PlantFile, StateFolder, located

New = Annotated[bool, typer.Option("--new", help="Make a new one first; the old one is void at once.")]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(token)


def token(
    role: Annotated[
        Role | None, typer.Argument(help="Whose token. [default: both]", show_default=False)
    ] = None,
    new: New = False,
    plant: PlantFile = None,
    state: StateFolder = None,
) -> None:
    """Show the token for viewers or operators of a plant that is open to a network (`up --host`)."""
    where = located(plant, state)
    if not (where / LOCK).exists():
        raise StartError(f"No plant keeps its state in {where}; open one by `arboleda up --host ADDRESS`.")
    if new:
        tokens.renew(where, [role] if role else list(Role))
    known = tokens.read(where)
    if role is not None:
        print(known[role])
        return
    for each, value in known.items():
        print(f"{each.value:9} {value}")
    print(f"kept in {where / tokens.TOKENS}")
