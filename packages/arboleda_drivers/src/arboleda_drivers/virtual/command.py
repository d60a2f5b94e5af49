"""The commands `arboleda virtual NAME`: each virtual controller, found beside the driver that it is for."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec

import typer

from arboleda.cli.overview import WholeSentences
from arboleda.drivers import text_of_error
from arboleda.drivers.port import GROUP
from arboleda.extension import Phrase, say
from arboleda.host.packages import entry_points

COMMAND = "virtual.command"  # in the folder of the driver
UNUSABLE = Phrase("cli.virtual.unusable", "the virtual controller {module} cannot be loaded: {why}")


def add_to(parent: typer.Typer) -> None:
    """Add the group, with the command of each virtual controller."""
    cli = typer.Typer(
        cls=WholeSentences,
        help="Play the controller of another maker over its own protocol, with motion and with faults.",
        no_args_is_help=True,
        rich_markup_mode=None,
    )
    for module in modules():
        try:
            import_module(module).add_to(cli)
        except Exception as error:  # noqa: BLE001 - it is code of another package: whatever it raises is told
            typer.echo(say(UNUSABLE(module=module, why=text_of_error(error))), err=True)
    parent.add_typer(cli, name="virtual")


def modules() -> Iterator[str]:
    """The modules of the commands, in the order of their names: one in each driver's folder that has one."""
    folders = {_folder(point.module) for point in entry_points(GROUP)}
    for folder in sorted(folders - {""}):
        if _exists(f"{folder}.{COMMAND}"):
            yield f"{folder}.{COMMAND}"


def _folder(module: str) -> str:
    """The package that a driver's module is in; "" if it is in none, or cannot be found."""
    try:
        spec = find_spec(module)
    except Exception:  # noqa: BLE001 - it is code of another package; a plant file that names it tells why
        return ""
    return "" if spec is None else spec.parent or ""


def _exists(module: str) -> bool:
    """True if the module is there; also where a package around it cannot be imported."""
    try:
        return find_spec(module) is not None
    except ModuleNotFoundError as error:
        return not f"{module}.".startswith(f"{error.name}.")
    except Exception:  # noqa: BLE001 - it is code of another package; whoever imports it is told why
        return True
