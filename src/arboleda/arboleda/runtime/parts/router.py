"""Router: the plant's port, which sends each command to the part that reaches its robot."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from arboleda.model.commands import Command
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Notice
from arboleda.model.plant_model import Link, PlantModel


class PlantPort(Protocol):
    """The way from the plant to its robots, or to some of them."""

    def send(self, message: Command | Notice) -> None: ...


class NoRoute(ArboledaError):
    """A command for a robot that nothing in this process reaches; it will not be sent later."""


class Router:
    """One port of several, by the link of each robot; every one of them hears every notice."""

    def __init__(self, model: PlantModel, ports: Mapping[Link, PlantPort]) -> None:
        self._links = {name: robot.link for name, robot in model.robots.items()}
        self._ports = ports
        self._each = list({id(port): port for port in ports.values()}.values())

    def send(self, message: Command | Notice) -> None:
        """Send a command or a notice; raises if a command cannot leave."""
        if isinstance(message, Command):
            self._port_of(message.robot).send(message)
            return
        for port in self._each:
            port.send(message)

    def _port_of(self, robot: str) -> PlantPort:
        link = self._links[robot]
        port = self._ports.get(link)
        if port is None:
            raise NoRoute(f"nothing in this process reaches {robot} (link: {link.value})")
        return port
