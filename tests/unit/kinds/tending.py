"""A cell whose recipes send robots to targets: two loaders, one of them with a gripper, and a shuttle."""

from __future__ import annotations

from arboleda.kinds import switch
from arboleda.kinds.arm import Arm
from arboleda.kinds.floor import Placement
from arboleda.kinds.joints import Joint
from arboleda.kinds.mobile import Grid, Mobile
from arboleda.model.plant_model import Cell, Evidence, Link, PlantModel, Pose, Robot, Workspace
from arboleda.model.recipe import Recipe

from ...plants import device_of, kind_of

GRIPPER = kind_of(
    "gripper",
    {"gripped": bool},
    close=switch(sets={"gripped": True}, at_most_s=2.0, holds_part=True),
    open=switch(sets={"gripped": False}, at_most_s=2.0, holds_part=True),
)
LAMP = kind_of(
    "lamp", {"lit": bool}, light=switch(parameters={"on": bool}, sets={"lit": "$on"}, at_most_s=2.0)
)
IDS = {"link": Link.MQTT, "evidence": Evidence.IDS}
HOME, FEED, FEED_2, VISE = (0.0, 0.0), (0.5, 0.2), (0.5, 0.4), (-0.5, 0.3)


def arm(name: str) -> Arm:
    joints = tuple(
        Joint(name=f"q{number}", lower=-1.0, upper=1.0, speed=1.0, acceleration=4.0, step=0.001)
        for number in (1, 2)
    )
    base = Placement(x=0.0, y=0.0)
    return Arm(name=name, mqtt=name, **IDS, timeout_s=5.0, model="two", twin=name, base=base, joints=joints)


def plant(*recipes: Recipe) -> PlantModel:
    """Both loaders reach the vise, which lies in the zone `vise`; the left one holds with its gripper."""
    left, right = arm("left"), arm("right")
    jaw, lamp = device_of(GRIPPER, "jaw"), device_of(LAMP)
    grid = Grid(origin=Placement(x=0.0, y=0.0), pitch=0.2)
    shuttle = Mobile(name="shuttle", mqtt="shuttle", **IDS, timeout_s=5.0, model="m", grid=grid, speed=0.5)
    devices: tuple[Robot, ...] = (left, right, jaw, lamp, shuttle)
    cell = Cell(
        name="tending",
        queue_limit=5,
        members=tuple((each.name, each) for each in devices),
        spaces=(_space(left, tool=jaw), _space(right), _grid(shuttle)),
        arrays=(("pallet", ("feed", "feed_2")),),
        zone_wait_s=10.0,
        recipes=recipes,
    )
    return PlantModel(name="shop", cells=(cell,), zones=("vise",))


def _grid(robot: Mobile) -> Workspace:
    dock = Pose(name="dock", q=0)
    return Workspace(robot=robot, home=dock, poses=(dock, Pose(name="store", q=8)))


def _space(robot: Arm, tool: Robot | None = None) -> Workspace:
    home = Pose(name="home", q=HOME)
    vise = Pose(name="vise", q=VISE, zones=frozenset({"vise"}))
    feeds = (Pose(name="feed", q=FEED, above=(0.5, 0.0)), Pose(name="feed_2", q=FEED_2))
    return Workspace(robot=robot, tool=tool, home=home, poses=(home, *feeds, vise))
