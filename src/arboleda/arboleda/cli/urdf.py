"""The command `arboleda urdf`: a robot of the plant for other programs."""

from __future__ import annotations

from typing import Annotated

import typer

from arboleda.plant_file import loader
from arboleda.plant_file.urdf import robot_urdf

from .plant_options import PlantFile


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(urdf)


def urdf(
    robot: Annotated[
        str, typer.Argument(metavar="ROBOT", help="A robot of the plant, e.g. ra1 or rm_sis_a.")
    ],
    plant: PlantFile = None,
) -> None:
    """Print a robot of the plant as URDF.

    To keep it: `arboleda urdf ra1 > ra1.urdf`. Joints have the names of /joint_states, limits and speeds are
    those of the plant file. The root link is base_link of an arm and grid_link of a mobile robot; where it
    stands is not part of it.

    Exit status: 0 printed, 1 the xacro library is missing, 2 bad input.
    """
    print(robot_urdf(loader.load(plant), robot), end="")
