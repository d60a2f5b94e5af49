"""Outlet of a plant: numbers its commands and stops, and puts them into the outbox."""

from __future__ import annotations

from dataclasses import replace

from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.messages import Notice
from arboleda.model.plant_model import Link

from .belief import Belief
from .underway import UnderWay, UnnamedCommands

UNSENT = (Link.NONE, Link.SCREEN)
"""The links over which nothing leaves the plant."""


class Outlet:
    """Outlet of commands to `outbox`; `count` is the number of the last command in this start, `epoch`."""

    def __init__(
        self,
        epoch: int,
        beliefs: dict[str, Belief],
        outbox: list[Command | Notice],
        under_way: UnderWay,
        unnamed: UnnamedCommands,
    ) -> None:
        self.epoch = epoch
        self.count = 0
        self._beliefs = beliefs
        self._outbox = outbox
        self._under_way = under_way
        self._unnamed = unnamed

    def new_id(self) -> str:
        """The id of the next command."""
        self.count += 1
        return f"{self.epoch}-{self.count}"

    def stop(self, robot: str, mode: StopMode) -> None:
        """Send a stop, a halt or a clear to a robot."""
        self.leave(Stop(id=self.new_id(), robot=robot, mode=mode))

    def leave(self, command: Command, token: str | None = None) -> None:
        """Send a command; a board that numbers its commands echoes `token`.

        The command names the last telemetry that the plant had heard, so that a board can refuse a late one.
        A stop names none, since no stop is too late.
        """
        belief = self._beliefs[command.robot]
        link = belief.robot.link
        if link in UNSENT:
            return
        number = None if isinstance(command, Stop) else belief.number
        if number is not None or (token is not None and link is Link.DRIVER):
            command = labelled(command, heard=number, token=token)
        self._outbox.append(command)
        self._under_way.leaves(command)
        self._unnamed.leaves(command)


def labelled(command: Command, *, heard: int | None, token: str | None) -> Command:
    """The same command with labels for its way."""
    if hasattr(command, "__slots__"):  # of a kind of one's own
        return replace(command, heard=heard, token=token)
    copy = object.__new__(type(command))  # several times as fast as `replace`
    object.__setattr__(copy, "__dict__", {**vars(command), "heard": heard, "token": token})
    return copy
