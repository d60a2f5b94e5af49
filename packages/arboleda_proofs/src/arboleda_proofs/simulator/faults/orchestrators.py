"""Other nodes that command: an orchestrator that was superseded, and one that knows no ids."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from arboleda.drivers import (
    Command,
    Device,
    FactType,
    FollowPath,
    Home,
    MoveJoints,
    SetEffector,
    Stop,
    StopMode,
    Value,
)
from arboleda.model.messages import Heartbeat
from arboleda.model.plant_model import PlantModel
from arboleda.rig.world import BRIDGE, World
from arboleda.wire.bridge import PLANT_GONE_S
from arboleda.wire.epochs import AHEAD_S
from arboleda.wire.hop import FromPlant
from arboleda.wire.strict import UINT32

from ..chance import Dice
from . import targets
from .kind import UNHEARD, Fault, kind, unheard, words

LATEST = 5  # how many epochs it may be behind
OF_ALL = ("home", "home", "clear", "clear", "beat", "beat")
ANY_VALUE: dict[type, tuple[Value, ...]] = {bool: (False, True), int: (0, 1), float: (0.0, 1.5), str: ("a",)}
RARE = ("halt", "stop")  # these count, whoever says them


def _orders(model: PlantModel, target: str) -> tuple[str, ...]:
    return (*_own(model, target), *(word for word in OF_ALL if _knows(model, target, word)), *RARE)


def _any_order(word: str) -> str:
    """One name for all orders but stops: the bridge passes none of them on."""
    return word if word in RARE else UNHEARD


@kind(targets=targets.robots, words=_orders, alike=_any_order)
def second_orchestrator(world: World, fault: Fault) -> None:
    """An orchestrator that was superseded speaks to the bridge; only its stops count."""
    dice = Dice(fault.seed, "second")
    # a start that has not yet beaten has superseded nobody
    newest = world.epoch_at_bridge or world.plant.epoch
    epoch = newest - 1 - dice.below(LATEST)
    message: Command | Heartbeat = Heartbeat(epoch=epoch)
    if fault.word != "beat":
        message = ORDERS[fault.word](world.model, fault.target, f"{epoch}-{1 + dice.below(10**9)}", dice)
    if world.is_on(BRIDGE):
        if (
            fault.word == "beat"
        ):  # to a bridge that has heard no plant this is its plant: the next one is older
            world.epoch_at_bridge = max(world.epoch_at_bridge, epoch)
        world.broker.clients[BRIDGE].inbox.append(FromPlant(at=world.now, message=message))


@kind(targets=targets.bridge, words=words("just too far", "the last number"), weight=0.5, alike=unheard)
def foreign_beat(world: World, fault: Fault) -> None:
    """A stranger beats as a plant that can only start in the far future; the bridge goes on with ours."""
    unix_s = world.plant.epoch
    epoch = UINT32 if fault.word == "the last number" else unix_s + AHEAD_S + 1
    if world.is_on(BRIDGE):
        beat = FromPlant(at=world.now, message=Heartbeat(epoch=epoch), unix_s=unix_s)
        world.broker.clients[BRIDGE].inbox.append(beat)


def _strange(model: PlantModel, target: str) -> tuple[str, ...]:
    words = ("home", "clear", "clear")
    return (*_own(model, target), *(word for word in words if _knows(model, target, word)), *RARE)


def _own(model: PlantModel, target: str) -> tuple[str, ...]:
    """The orders for robots of this kind alone; a repeated one is drawn more often."""
    robot = model.robots[target]
    if robot.joints:
        return ("move", *(("effector on", "effector off") if robot.has_effector else ())) * 4
    if robot.floor_grid:
        return ("path",) * 8
    return ("order",) * 8 if robot.verb_names else ()  # some only report


def _knows(model: PlantModel, target: str, word: str) -> bool:
    return word != "home" or model.robots[target].homes


@kind(targets=targets.robots, words=_strange, alike=_any_order)
def foreign_command(world: World, fault: Fault) -> None:
    """A node of somebody else commands a robot on its plain topic; only its stops count."""
    # a bridge that hears no plant would obey the stranger as its only orchestrator
    if not world.is_on(BRIDGE) or world.now >= world.beat_reached_bridge_at + PLANT_GONE_S:
        return
    order = ORDERS[fault.word](world.model, fault.target, "", Dice(fault.seed, "foreign"))
    message = FromPlant(at=world.now, message=order, sender="/stranger")
    world.broker.clients[BRIDGE].inbox.append(message)


def _move(model: PlantModel, robot: str, id: str, dice: Dice) -> Command:
    space = model.cell_of[robot].workspaces.get(robot)
    q = dice.pick([pose.joints for pose in space.poses]) if space else model.robots[robot].reference
    assert isinstance(q, tuple)
    return MoveJoints(id=id, robot=robot, q=q)


def _path(model: PlantModel, robot: str, id: str, dice: Dice) -> Command:
    space = model.cell_of[robot].reach.get(robot)
    if space is not None and space.paths:
        return FollowPath(id=id, robot=robot, nodes=dice.pick(space.paths).nodes)
    goals = [pose.q for pose in space.poses] if space else [0]
    return model.robots[robot].go(id=id, way=(dice.pick(goals),))


def _verb(model: PlantModel, robot: str, id: str, dice: Dice) -> Command:
    """Any verb of a device, with any of the values that it takes."""
    kind = cast(Device, model.robots[robot]).kind
    verb = kind.verbs[dice.pick(list(kind.verbs))]
    values = {name: dice.pick(_values(type)) for name, type in verb.parameters}
    return kind.command(id=id, robot=robot, verb=verb.name, values=values)


def _values(type: FactType) -> tuple[Value, ...]:
    return type.samples if type.words or type.is_limited else ANY_VALUE[type.type]


def _switch(on: bool) -> Order:
    return lambda model, robot, id, dice: SetEffector(id=id, robot=robot, on=on)


def _stop(mode: StopMode) -> Order:
    return lambda model, robot, id, dice: Stop(id=id, robot=robot, mode=mode)


Order = Callable[[PlantModel, str, str, Dice], Command]
ORDERS: dict[str, Order] = {
    "move": _move,
    "path": _path,
    "order": _verb,
    "effector on": _switch(True),
    "effector off": _switch(False),
    "home": lambda model, robot, id, dice: Home(id=id, robot=robot),
    "clear": _stop(StopMode.CLEAR),
    "halt": _stop(StopMode.HALT),
    "stop": _stop(StopMode.LATCH),
}

KINDS = (second_orchestrator, foreign_command, foreign_beat)
