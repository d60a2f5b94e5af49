"""The command `arboleda`."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from arboleda import __version__
from arboleda.model.errors import ArboledaError

from .complaint import complain, status_of
from .overview import Overview

cli = typer.Typer(
    cls=Overview,
    help="Run robot cells by behavior trees: simulated on this machine, or real over MQTT and ROS 2.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(wanted: bool) -> None:
    if wanted:
        print(f"arboleda {__version__}")
        raise typer.Exit


@cli.callback()
def common(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Run robot cells by behavior trees: simulated on this machine, or real over MQTT and ROS 2."""


def main() -> None:
    """The entry point: prints any trouble as one sentence on standard error."""
    try:
        cli(prog_name="arboleda")
    except ArboledaError as error:
        complain(error)
        sys.exit(status_of(error))
