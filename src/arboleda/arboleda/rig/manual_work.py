"""Manual work: what a person does to the robots and devices of a world at the machines themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from arboleda.model.facts import Facts
from arboleda.model.messages import Verb
from arboleda.sim.arm import ArmBody

if TYPE_CHECKING:
    from .world import World

BY_HAND_S = 1.0  # from putting a robot right by hand to declaring it


class ManualWork:
    """Manual work at robots that stand still; a scope is a robot, a cell, or empty for the plant."""

    def __init__(self, world: World) -> None:
        self._world = world

    def home(self, scope: str) -> None:
        """Put the robots of a scope at their reference, and declare that."""
        self.put_at_reference(scope)
        self._world.at(self._world.now + BY_HAND_S, self._declare_homed, scope)

    def put_at_reference(self, scope: str) -> None:
        """Move the robots of a scope to where their counters begin."""
        boards, put_right = self._world.boards, self._world.moment.put_right
        for name in self._boards_of(scope):
            if not boards[name].body.moving:
                boards[name].put_at_reference()
                put_right.append(name)

    def release(self, scope: str) -> None:
        """Take out what the robots of a scope hold, and declare that."""
        self.take_out(scope)
        self._world.at(self._world.now + BY_HAND_S, self._declare_empty, scope)

    def take_out(self, scope: str) -> None:
        """Take out what the robots of a scope hold."""
        moment = self._world.moment
        for name in self._boards_of(scope):
            body = self._world.boards[name].body
            if not body.moving:
                opens = isinstance(body, ArmBody) and body.effector
                body.take_out()
                moment.put_right.append(name)
                moment.opened += [name] if opens else []

    def open_effector(self, board: str) -> None:
        """Open an effector as if by somebody else than this plant; its board says that it is off."""
        body = self._world.boards[board].body
        if isinstance(body, ArmBody) and self._world.is_on(board) and not body.stuck:
            body.switch_effector(False)
            self._world.moment.opened.append(board)

    def set_facts(self, board: str, facts: Facts) -> None:
        """Make facts so at a device, as by opening its door."""
        self._world.boards[board].body.set_by_hand(facts)
        self._world.moment.put_right.append(board)

    def _declare_homed(self, scope: str) -> None:
        """Declare robots homed, unless one moves; one that has booted since is put right again."""
        if not any(self._world.boards[name].body.moving for name in self._boards_of(scope)):
            self.put_at_reference(scope)
            self._world.request_verb(Verb.HOME, scope, by_hand=True)

    def _declare_empty(self, scope: str) -> None:
        self._world.request_verb(Verb.RELEASE, scope, by_hand=True)

    def _boards_of(self, scope: str) -> list[str]:
        """The boards of a robot, a cell or the plant."""
        model, scope = self._world.model, scope.strip().lower()
        cells = {cell.name: [robot.name for robot in cell.robots] for cell in model.cells}
        robots = cells.get(scope, [scope] if scope in model.robots else list(model.robots))
        return [model.robots[name].mqtt for name in robots]
