"""Goal of a command in a board's terms: checked against the robot, quantised, in wire units."""

from __future__ import annotations

from arboleda.model.commands import Command
from arboleda.model.plant_model import Robot

from .forms import form_of
from .payloads import Goal
from .topics import Channel


def refusal(robot: Robot, command: Command) -> str | None:
    """The word that refuses a command which the robot can never carry out; None if it can."""
    form = form_of(robot)
    way = form.way(type(command))
    return form.missing.get(type(command), "formato") if way is None else way.refusal(robot, command)


def goal(robot: Robot, command: Command, **stamp: int | None) -> tuple[Channel, Goal]:
    """The channel and payload of a command that `refusal` accepted; `stamp` has its `seq` and `epoch`.

    For all commands but a stop, `stamp` also has `heard`.
    """
    way = form_of(robot).way(type(command))
    assert way is not None
    return way.channel, way.goal(**way.body(robot, command), **stamp)  # type: ignore[arg-type]
