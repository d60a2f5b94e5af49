"""Lookup of the ROS 2 side of virtual action servers, for their commands."""

from __future__ import annotations

from collections.abc import Callable
from importlib.metadata import entry_points
from typing import Annotated

import typer

from arboleda.model.errors import StartError

from ..serving import Controller

Lan = Annotated[bool, typer.Option("--lan", help="Let clients on other machines reach it.")]
JointStates = Annotated[str, typer.Option(help="The topic of its joint states.")]
Rate = Annotated[float, typer.Option(min=1, max=1000, help="How often that is measured, Hz.")]


def controller(name: str) -> Callable[..., Controller]:
    """The function that runs it over ROS 2; StartError if arboleda_ros or rclpy is missing."""
    found = next(iter(entry_points(group="arboleda.virtual", name=name)), None)
    try:
        if found is None:
            raise ImportError("arboleda_ros is not installed")
        made: Callable[..., Controller] = found.load()
    except ImportError as error:
        why = f"arboleda virtual {name} needs ROS 2, which cannot be used here ({error})"
        raise StartError(f"{why}; source a ROS 2, or python3 -m pip install 'arboleda[ros]'") from error
    return made
