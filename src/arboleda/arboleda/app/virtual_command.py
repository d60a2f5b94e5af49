"""The commands `arboleda virtual KIND`: every virtual controller that there is, a row each."""

from __future__ import annotations

import typer

from arboleda.virtual.dobot import command as dobot

cli = typer.Typer(
    help="Play the controller of another maker over its own protocol, with motion and with faults.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
cli.command("dobot", help=dobot.HELP)(dobot.run)
