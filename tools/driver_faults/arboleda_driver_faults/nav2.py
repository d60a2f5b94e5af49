"""Campaign of a base that Nav2 drives over a grid, as in examples/nav2."""

from __future__ import annotations

from collections.abc import Collection

from arboleda.kinds.mobile import Mobile
from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel
from arboleda_drivers.nav2 import machine as driver
from arboleda_drivers.nav2.machine import Route
from arboleda_drivers.nav2.pose import Pose
from arboleda_drivers.nav2.virtual.machine import BaseBody, Drive

from .ros_action import CAUSES, NO_LINK, ActionRig, Part

STANDS_M = 0.15  # somewhat more than what the driver calls standing on a node
BESIDE = {Reason.DEVICE_FAULT, Reason.NOT_REACHED}
BASE_CAUSES = {
    **CAUSES,
    "lie": BESIDE,
    "early": BESIDE,  # it rests a moment on each node
    "short": BESIDE,
    "stall": {Reason.DEADLINE, *BESIDE},
    "stuck": {Reason.DEADLINE, *BESIDE, *NO_LINK},  # then odometry jumps as far as it had gone meanwhile
    "unlocalised": NO_LINK,
    "jump": {*BESIDE, *NO_LINK},
    "no_odometry": NO_LINK,
    "missed": {Reason.DEVICE_FAULT},
    "wrong_frame": {Reason.REJECTED},
}


def _base(faults: Collection[str]) -> BaseBody:
    return BaseBody(faults, start=Pose(0.0, 0.0), speed=1.0)


def _drive(route: Route) -> Drive:
    return Drive(frame=route.frame, poses=route.poses)


class RoundRig(ActionRig):
    """Test with a base that drives round the grid; it sees the node of the base."""

    work = (6, 8, 0)
    parts = (Part(name="cart", machine=driver.to_pose, body=_base, read=_drive, causes=BASE_CAUSES),)
    between_s = 30.0
    after_s = 60.0

    def __init__(self, example: PlantModel) -> None:
        super().__init__(example)
        (cart,) = example.robots.values()
        assert isinstance(cart, Mobile)
        self._nodes = {node: cart.grid.position(node) for node in range(cart.grid.size)}

    def task(self, number: int) -> str:
        return f"{self.cell.name} round left right #{number}"

    def place(self) -> int | None:
        x, y, _ = self.bodies["cart"].position
        here = Pose(x, y)
        at = (node for node, place in self._nodes.items() if here.distance(Pose(*place)) < STANDS_M)
        return next(at, None)


class WaypointsRig(RoundRig):
    """The same test with all nodes of a way as one goal."""

    parts = (Part(name="cart", machine=driver.waypoints, body=_base, read=_drive, causes=BASE_CAUSES),)
