"""Notes for a person on plants that are simulated."""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.model.plant_model import Link
from arboleda.plant_check.unstated import unknowns

from .plants import ELSEWHERE, Plant


def notes(plants: Iterable[Plant]) -> list[str]:
    """The notes for a person on how these plants are simulated, and on what nobody can judge in them."""
    listed = list(plants)
    robots = [robot for plant in listed for robot in plant.declared.robots.values()]
    names = {link: ", ".join(robot.name for robot in robots if robot.link is link) for link in Link}
    instead = "simulated as if each had a virtual board on MQTT"
    others = [link for link in ELSEWHERE if names[link]]
    linked = [f"declared link: {link.value}, {instead}: {names[link]}" for link in others]
    return [*linked, *unjudged(listed)]


def unjudged(plants: Iterable[Plant]) -> list[str]:
    """The sentences on what nobody can judge in these plants, as their files do not state it."""
    return [sentence for plant in plants for sentence in unknowns(plant.declared)]
