"""Which plant a command talks to: its file, its state directory, and the client of both."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from . import config
from .client import PlantClient
from .state import default_state

PlantFile = Annotated[
    Path | None, typer.Option("--plant", metavar="FILE", help="Plant file. [default: the shipped plant]")
]
StateFolder = Annotated[
    Path | None,
    typer.Option(
        "--state",
        metavar="DIR",
        help="Where the plant keeps its state. [default: $XDG_STATE_HOME/arboleda/<plant name>]",
    ),
]


def client(plant: Path | None, state: Path | None) -> PlantClient:
    """The client of the plant that runs on `state`, or where that plant file keeps its state."""
    return PlantClient(folder(plant, state))


def folder(plant: Path | None, state: Path | None) -> Path:
    """`state`, or where that plant file keeps its state."""
    return state or default_state(config.load(plant).name)
