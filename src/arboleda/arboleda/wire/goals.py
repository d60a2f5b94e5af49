"""A core command as a board understands it: checked against the robot, quantised, in wire units."""

from __future__ import annotations

from arboleda.model.commands import Command
from arboleda.model.plant_model import Robot

from .forms import form_of
from .payloads import Goal
from .topics import Channel


def refusal(robot: Robot, command: Command) -> str | None:
    """The word that refuses a command the robot can never carry out; None where it can."""
    form = form_of(robot)
    way = form.way(type(command))
    return form.missing.get(type(command), "formato") if way is None else way.refusal(robot, command)


def goal(robot: Robot, command: Command, *, seq: int | None, epoch: int | None) -> tuple[Channel, Goal]:
    """The channel and the payload of a command that `refusal` let through."""
    way = form_of(robot).way(type(command))
    assert way is not None
    return way.channel, way.goal(**way.body(robot, command), seq=seq, epoch=epoch)  # type: ignore[arg-type]
