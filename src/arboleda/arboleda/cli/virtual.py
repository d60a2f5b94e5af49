"""The commands `arboleda virtual KIND`: every virtual controller, a row each."""

from __future__ import annotations

import typer

from arboleda.virtual.dobot import command as dobot
from arboleda.virtual.gcode import command as gcode
from arboleda.virtual.gripper import command as gripper
from arboleda.virtual.modbus import command as modbus
from arboleda.virtual.nav2 import command as nav2
from arboleda.virtual.opcua import command as opcua
from arboleda.virtual.s7 import command as s7
from arboleda.virtual.serial_arm import command as serial_arm
from arboleda.virtual.trajectory import command as trajectory
from arboleda.virtual.ur import command as ur
from arboleda.virtual.vda5050 import command as vda5050

from .overview import WholeSentences

cli = typer.Typer(
    cls=WholeSentences,
    help="Play the controller of another maker over its own protocol, with motion and with faults.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
cli.command("dobot", help=dobot.HELP)(dobot.run)
cli.command("ur", help=ur.HELP)(ur.run)
cli.command("vda5050", help=vda5050.HELP)(vda5050.run)
cli.command("modbus", help=modbus.HELP)(modbus.run)
cli.command("opcua", help=opcua.HELP)(opcua.run)
cli.command(gcode.NAME, help=gcode.HELP)(gcode.run)
cli.command(serial_arm.NAME, help=serial_arm.HELP)(serial_arm.run)
cli.command("s7", help=s7.HELP)(s7.run)
cli.command("trajectory", help=trajectory.HELP)(trajectory.run)
cli.command(gripper.NAME, help=gripper.HELP)(gripper.run)
cli.command("nav2", help=nav2.HELP)(nav2.run)


def add_to(parent: typer.Typer) -> None:
    """Add the group."""
    parent.add_typer(cli, name="virtual")
