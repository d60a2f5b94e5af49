"""Interlocks of a cell in a scene: which machines keep a zone for certain."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from arboleda.model.commands import Command
from arboleda.model.facts import Value, shown
from arboleda.model.plant_model import Cell, Interlock, Pose

from .scene import AT, Key, Scene


class ForeseenLocks:
    """Interlocks of one cell, of machines that no other cell shares."""

    def __init__(self, cell: Cell) -> None:
        self.cell = cell
        self._free = [each for each in cell.interlocks if each.free_while and each.device not in cell.shared]

    def let_in(self, robot: str, target: str | None) -> Iterator[tuple[Key, Value]]:
        """The facts that let a robot into the zones of a target, so far as nothing but verbs changes them."""
        for lock in self._locks(robot, target):
            device: Any = next(each for each in self.cell.robots if each.name == lock.device)
            verbs = device.kind.verbs.values() if device.verb_names else ()
            names = {name for verb in verbs for name, _ in verb.sets}
            for fact, value in lock.free_while:
                if fact in names:
                    yield (lock.device, fact), value

    def _locks(self, robot: str, target: str | None) -> Iterator[Interlock]:
        """The machines that keep a robot out of the zones of a target by their facts."""
        zones = self.cell.reach[robot].targets[target].zones if target is not None else ()
        return (lock for lock in self._free if lock.zone in zones and lock.device != robot)

    def locked(self, robot: str, target: str | None, scene: Scene) -> Iterator[tuple[str, str]]:
        """The facts that keep a robot out of the zones of a target, and what they have to be."""
        for lock in self._locks(robot, target):
            yield from _kept(lock, scene)

    def closing(self, command: Command, scene: Scene) -> Iterator[str]:
        """The mistakes of a command that closes a zone."""
        for lock in self.cell.interlocks_of(command.robot):
            if lock.is_ended_by(command):
                for name, pose in self._standing(scene):
                    if lock.zone in pose.zones and name != command.robot:
                        yield f"has {command.robot} {command.word} while {name} stands at {pose.name}"
                yield from self._shut_out(command, lock.zone, scene)

    def _shut_out(self, command: Command, zone: str, scene: Scene) -> Iterator[str]:
        """The machines that are in a zone which a command takes: a zone has one of them at a time."""
        for lock in (each for each in self._free if each.zone == zone and each.device != command.robot):
            for is_so, value in _kept(lock, scene):
                waits = f"has {command.robot} {command.word} in the zone {zone}, which {lock.device} keeps"
                yield f"{waits} while {is_so}; it has to be {value}, or each has a zone of its own"

    def _standing(self, scene: Scene) -> Iterator[tuple[str, Pose]]:
        for space in self.cell.spaces:
            at = scene.get(space.robot.name, AT)
            if at is not None:
                yield space.robot.name, space.targets[str(at)]


def _kept(lock: Interlock, scene: Scene) -> Iterator[tuple[str, str]]:
    """The facts by which a machine keeps its zone for certain, and what they have to be."""
    for fact, value in lock.free_while:
        known = scene.get(lock.device, fact)
        if known not in (None, value):
            yield f"{fact} of {lock.device} is {shown(known)}", shown(value)
