"""The command `arboleda firmware-config`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, cast

import typer

from arboleda.cli.language import allowed
from arboleda.cli.new import WROTE
from arboleda.drivers import Device, Robot, quoted
from arboleda.extension import Phrase, PlantFile, load, say
from arboleda.model.plant_model import Link, PlantModel
from arboleda_boards.firmware_config.header import header
from arboleda_boards.firmware_config.resolving import tables

HELP = """Write the header with which the boards' firmware becomes a device of a declared kind.

WIRING is a YAML file that says which pins are inputs, outputs, servos and analog inputs, what each fact of
the kind is read from, and what each verb drives. Every mistake is named with its line. What no input looks
at is named as well: the board says of it what it was told, and that proves nothing.

Exit status: 0 written, 2 bad input."""

NO_INPUT = Phrase(
    "cli.firmware.no_input",
    "note: {name} is said as it was told; no input looks at it, so it proves nothing",
)
NO_DEVICE = Phrase("cli.firmware.no_device", "{name} is no device of a declared kind; {others}")
Name = Annotated[
    str, typer.Argument(metavar="DEVICE", help="The device's name on MQTT, or in the plant file.")
]
Wiring = Annotated[Path, typer.Argument(metavar="WIRING", help="How it is wired, in YAML.")]
Output = Annotated[
    Path | None,
    typer.Option("--output", "-o", metavar="FILE", help="The file to write. [default: it is printed]"),
]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""

    def firmware_config(device: Name, wiring: Wiring, plant: PlantFile = None, output: Output = None) -> None:
        made = tables(_named(load(plant), device), wiring)
        text = header(made)
        for name in made.unseen:
            typer.echo(say(NO_INPUT(name=name)), err=True)
        if output is None:
            print(text, end="")
            return
        output.write_text(text, encoding="utf-8")
        typer.echo(say(WROTE(file=str(output))), err=True)

    cli.command("firmware-config", help=HELP, short_help=HELP.partition("\n")[0])(firmware_config)


def _named(model: PlantModel, name: str) -> Device:
    devices = {robot.mqtt: robot for robot in model.robots.values() if _has_verbs_on_mqtt(robot)}
    devices |= {robot.name: robot for robot in devices.values()}
    found = devices.get(name)
    if found is None:
        wrong = NO_DEVICE(name=quoted(name), others=allowed(name, sorted(devices)))
        raise typer.BadParameter(say(wrong), param_hint="DEVICE")
    return cast(Device, found)


def _has_verbs_on_mqtt(robot: Robot) -> bool:
    return robot.link is Link.MQTT and bool(robot.verb_names)
