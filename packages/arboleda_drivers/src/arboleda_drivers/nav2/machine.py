"""Mobile base that Nav2 drives from node to node of the plant's grid."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from arboleda.drivers import Command, FollowPath, Mobile, Robot
from arboleda_drivers.ros_action.events import GoalResult, Measurement
from arboleda_drivers.ros_action.machine import Machine
from arboleda_drivers.ros_action.mover import NoGoal, failure

from .localisation import Localisation
from .pose import Pose
from .settings import Settings


@dataclass(frozen=True, kw_only=True)
class Route:
    """Goal: poses on the map, and the nodes that they belong to."""

    frame: str
    nodes: tuple[int, ...]
    poses: tuple[Pose, ...]


Split = Callable[[Route], tuple[Route, ...]]


class BaseMover:
    """Mobile base, measured by localisation and odometry; `split` makes goals of a way."""

    replaces = False

    def __init__(self, mobile: Mobile, settings: Settings, split: Split) -> None:
        self.name = mobile.name
        self._mobile, self._settings, self._split = mobile, settings, split
        self._where = Localisation(
            odometry=settings.odometry,
            localisation=settings.localisation,
            far_m=settings.unlocalised_m,
        )
        self._node: int | None = None  # the last one that it stood on

    def see(self, now: float, measurement: Measurement) -> bool:
        if not self._where.see(now, measurement):
            return False
        node = self._stands_on()
        self._node = self._node if node is None else node
        return True

    def missing(self, now: float) -> str:
        return self._where.missing(now)

    def goals(self, command: Command) -> tuple[Route, ...]:
        if not isinstance(command, FollowPath):
            raise NoGoal(f"Nav2 has no word for {type(command).__name__}")
        here, *ahead = command.nodes
        return self._split(self._route(ahead if ahead and here == self._stands_on() else command.nodes))

    def has_measured_since(self, at: float) -> bool:
        return self._where.measured_at > at

    def is_at(self, goal: Route) -> bool:
        return self._stands_on() == goal.nodes[-1]

    def rests(self, now: float, since: float = 0.0) -> bool:
        return self._where.rest.holds(now, since)

    def failure(self, end: GoalResult, goal: Route) -> str:
        if end.missed:  # a server may end so as a success
            names = ", ".join(str(goal.nodes[each]) for each in end.missed if each < len(goal.nodes))
            return f"missed_waypoints node {names}" if names else "missed_waypoints"
        return failure(end, {})

    def objection(self, goal: Route) -> str:
        """The word `stands_on_no_node` if the base stands on none, else "".

        That it stands on another node than the goal, the plant sees for itself.
        """
        return "stands_on_no_node" if self._stands_on() is None else ""

    def settle(self, goal: Route | None) -> None:
        """Does nothing: a base keeps no state beyond its goal."""

    def shows(self, *, busy: bool) -> dict[str, Any]:
        """The node for a report: under way, the last one passed; at rest, the one stood on, if any."""
        return {"node": self._node if busy else self._stands_on()}

    def _route(self, nodes: Sequence[int]) -> Route:
        """The poses of nodes, each with the direction in which the base arrives there."""
        places = [self._place(node) for node in nodes]
        here = self._where.pose
        assert here is not None
        poses, before = [], here
        for place in places:
            if before.distance(place) > self._settings.tolerance_m:
                yaw = math.atan2(place.y - before.y, place.x - before.x)
            else:
                yaw = before.yaw
            before = Pose(place.x, place.y, yaw)
            poses.append(before)
        return Route(frame=self._settings.frame, nodes=tuple(nodes), poses=tuple(poses))

    def _place(self, node: int) -> Pose:
        """The pose of a node on the map."""
        grid = self._mobile.grid
        origin = Pose(grid.origin.x, grid.origin.y, grid.origin.yaw)
        return self._settings.floor @ origin @ Pose(*grid.position(node))

    def _stands_on(self) -> int | None:
        pose = self._where.pose
        if pose is None:
            return None
        near = min(range(self._mobile.grid.size), key=lambda node: pose.distance(self._place(node)))
        return near if pose.distance(self._place(near)) <= self._settings.tolerance_m else None


def each_alone(route: Route) -> tuple[Route, ...]:
    """A goal for each node of a way."""
    rows = zip(route.nodes, route.poses, strict=True)
    return tuple(Route(frame=route.frame, nodes=(node,), poses=(pose,)) for node, pose in rows)


def all_at_once(route: Route) -> tuple[Route, ...]:
    return (route,)


def machine(devices: Sequence[Robot], settings: Settings, *, split: Split) -> Machine:
    """The machine of one mobile robot; raises ValueError for other devices."""
    if len(devices) != 1 or not isinstance(devices[0], Mobile):
        raise ValueError("Nav2 drives one mobile robot")
    return Machine(BaseMover(devices[0], settings, split), settings.action)


to_pose = partial(machine, split=each_alone)
waypoints = partial(machine, split=all_at_once)
