"""Truth about one mobile robot: at which node it is."""

from __future__ import annotations

from arboleda.drivers import Mobile, Position
from arboleda.model.plant_model import Cell
from arboleda.rig.network import Client
from arboleda.sim.board import Board
from arboleda.sim.mobile import MobileBody
from arboleda.sim.starts import start_of
from arboleda.wire.payloads import PathGoal

from .robot import NOWHERE, RobotTruth


class MobileTruth(RobotTruth):
    """Truth about one mobile robot: `node` is where it stands, or what it passed last while on an edge.

    `counted` is where it takes itself to be; `strayed`: that is wrong though it is homed, as somebody moved
    it unseen. `goal` is the last node of the path that it drives or drove last.
    """

    SIGNS = ("next_change_us", "true_node")
    PLACE = "node"
    body: MobileBody

    def __init__(self, robot: Mobile, cell: Cell, board: Board, client: Client) -> None:
        super().__init__(robot, cell, board, client)
        self.node, self.counted = self.body.true_node, self.body.node
        self.goal: int | None = None
        space = cell.workspaces.get(robot.name)
        self._poses = space.poses if space else ()
        self.here, self.zones = self._located()
        self._reference = start_of(cell, robot.name) or 0  # where homing ends

    @property
    def strayed(self) -> bool:
        return self.homed and self.node != self.counted

    def stands_at(self, place: Position) -> bool:
        """True if it stands at the node, or would if nobody had moved it."""
        return not self.moving and place in (self.node, self.counted if self.strayed else None)

    @property
    def at_reference(self) -> bool:
        return not self.moving and self._came_home

    @property
    def _came_home(self) -> bool:
        return self.body.true_node == self._reference

    def _follow(self, was_moving: bool) -> None:
        still = not (was_moving or self.moving or self.lost_power)
        self.jumped = still and self.body.node != self.counted
        self.node, self.counted = self.body.true_node, self.body.node
        self.stood = self.here
        self.here, self.zones = self._located()
        for act in self.acts:
            if isinstance(act.goal, PathGoal):
                self.goal = act.goal.nodes[-1]

    def _located(self) -> tuple[frozenset[str], frozenset[str]]:
        """The targets at which it stands, and the zones of those that it stands at or comes by."""
        there = [pose for pose in self._poses if pose.q == self.node]
        here = NOWHERE if self.body.moving else frozenset(pose.name for pose in there)
        return here, NOWHERE.union(*(pose.zones for pose in there))

    def _ends_soon(self, now_us: int) -> bool:
        return True  # it always has an edge to finish

    def _goes_on(self) -> bool:
        return self.body.node != self.counted  # and so on a further edge
