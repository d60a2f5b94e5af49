"""Strangers who publish on the plant's topics.

A stranger with a valid command of a fresher epoch, or with telemetry that makes sense, would simply be the
bridge or the board: MQTT has no other proof of who speaks, so that is out of scope. What they repeat and
what they make up here is never fresher than what the board has heard since it booted; to a board that has
heard nothing yet, everything is fresh, and they leave it alone.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable

from arboleda.drivers import Robot, StopMode
from arboleda.model.plant_model import PlantModel
from arboleda.rig.world import BRIDGE, World
from arboleda.wire.forms import form_of
from arboleda.wire.payloads import Goal, StopGoal, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Delivery, Publication

from ..chance import Dice
from . import targets
from .kind import UNHEARD, End, Fault, kind, unheard, words
from .orchestrators import ORDERS
from .shared_effects import hold

OF_ALL = (Channel.STOP, Channel.HOME, Channel.BEAT, Channel.TELEMETRY, Channel.PRESENCE)
OF_JOINTS, OF_MOBILES, OF_DEVICES = (Channel.JOINTS,), (Channel.PATH,), (Channel.ORDER,)
GARBAGE = (
    b"",
    b"\xff\xfe\x00\x01",
    b"{",
    b"null",
    b"[]",
    b"true",
    b'"1"',
    b"[" * 300,
    b" " * 600,
    b'{"seq":NaN,"epoca":1e999}',
    b'{"seq":1,"seq":1,"epoca":1}',
    b'{"q1":true,"q2":0,"q3":0,"seq":1,"epoca":1.5}',
    b'{"q1":"45","q2":0,"q3":0,"seq":"1","epoca":null}',
    b'{"paro":3,"seq":1,"epoca":-1}',
    b'{"paro":"1","seq":1,"epoca":"9"}',
    b'{"efector":2,"ref":0,"nodos":[],"epoca":4294967296}',
    b'{"nodos":[0,"3"],"efector":true,"ref":true,"paro":true,"epoca":true}',
    b'{"estado":7,"q1_mov":null,"nodo":-1,"epoca":[]}',
)


def _channels(model: PlantModel, target: str) -> tuple[str, ...]:
    robot = targets.robot_of(model, target)
    own = OF_JOINTS if robot.joints else OF_MOBILES if robot.floor_grid else OF_DEVICES
    held = (Channel.EFFECTOR,) if robot.has_effector else ()
    return tuple(channel.value for channel in (*own, *held, *OF_ALL))


@kind(targets=targets.boards, words=_channels, alike=unheard)
def foreign_garbage(world: World, fault: Fault) -> None:
    """A stranger publishes what makes no sense on a topic of a board."""
    payload = Dice(fault.seed, "garbage").pick(GARBAGE)
    world.publish(Publication(topic=f"{fault.target}/{fault.word}", payload=payload))


FOREIGN_TO_ARMS: dict[str, object] = {"nodo": 0}
FOREIGN_TO_MOBILES: dict[str, object] = {"efector": 0, "pieza": 1, "q1_mov": 0.0}
LATER_S = 0.02  # before the board speaks again
AGAIN = "again"  # the last command, in the words of `foreign_old`
NEWEST = 4_000_000_000  # a telemetry number above that of any board


def _foreign(model: PlantModel, target: str) -> tuple[str, ...]:
    has_joints = bool(targets.robot_of(model, target).joints)
    return tuple(FOREIGN_TO_ARMS if has_joints else FOREIGN_TO_MOBILES)


@kind(targets=targets.goers, words=_foreign, weight=0.5, alike=unheard)
def foreign_report(world: World, fault: Fault) -> None:
    """A stranger publishes telemetry in which a board says what its kind of robot cannot."""
    robot = targets.robot_of(world.model, fault.target)
    own = {f"q{number + 1}_mov": 0.0 for number in range(len(robot.joints))}
    foreign = {**FOREIGN_TO_ARMS, **FOREIGN_TO_MOBILES}[fault.word]
    fields = {**(own or {"nodo": 6}), "estado": 0, "seq": NEWEST, "arranque": 1, fault.word: foreign}
    payload = json.dumps(fields, separators=(",", ":")).encode()
    world.publish(Publication(topic=topic(fault.target, Channel.TELEMETRY), payload=payload))


@kind(targets=targets.boards, seconds=(0.5, 10.0), weight=0.7, alike=unheard)
def foreign_repeat(world: World, fault: Fault) -> End:
    """The broker was told to keep what a board says, and says it to the bridge once more, as retained."""
    address = topic(fault.target, Channel.TELEMETRY)

    def again(publication: Publication) -> None:
        bridge = world.broker.clients[BRIDGE]
        if bridge.connected:
            kept = Delivery(at=world.now, topic=address, payload=publication.payload, retain=True)
            bridge.inbox.append(kept)

    def carry(publication: Publication) -> Iterable[Publication]:
        if publication.topic == address:
            world.at(world.now + LATER_S, again, publication)
        return (publication,)

    world.carriers.append(carry)
    return lambda: world.carriers.remove(carry)


@kind(
    targets=targets.boards,
    words=words("no board", "no channel", "too long", "too deep"),
    weight=0.5,
    alike=unheard,
)
def foreign_stray(world: World, fault: Fault) -> None:
    """A stranger publishes on a topic that belongs to nobody, or far more than fits."""
    world.publish(STRAYS[fault.word](fault.target))


STRAYS: dict[str, Callable[[str], Publication]] = {
    "no board": lambda board: Publication(topic="nobody/juntas", payload=b'{"q1":0}'),
    "no channel": lambda board: Publication(topic=f"{board}/nada/juntas", payload=b'{"q1":0}'),
    "too long": lambda board: Publication(
        topic=f"{board}/paro", payload=b'{"paro":1,"x":"%s"}' % (b"x" * 9000)
    ),
    "too deep": lambda board: Publication(topic=f"{board}/sensores", payload=b'{"a":' * 300),
}


def _goals(model: PlantModel, target: str) -> tuple[str, ...]:
    """The goals that can be ordered of a robot, without stops, which are a kind of fault of their own."""
    robot = targets.robot_of(model, target)
    if robot.joints:
        held = ("effector on", "effector off") if robot.has_effector else ()
        return ("move", *held, "home", "clear")
    return ("path", "home", "clear") if robot.floor_grid else ("order", "clear")


@kind(targets=targets.boards, words=_goals, seconds=(1.0, 60.0), weight=0.7, alike=unheard)
def foreign_retained(world: World, fault: Fault) -> End | None:
    """A stranger has the broker keep an old command for whoever subscribes, until somebody takes it away."""
    old = _old(world, fault)
    if old is None:
        return None
    world.publish(old._replace(retain=True))
    return hold(world, "retained", old.topic, lambda: world.broker.retained.pop(old.topic, None))


@kind(
    targets=targets.boards,
    words=lambda model, target: (AGAIN, *_goals(model, target)),
    alike=lambda word: word if word == AGAIN else UNHEARD,
)
def foreign_old(world: World, fault: Fault) -> None:
    """A stranger repeats the last command, or sends one of an older number, epoch or bridge."""
    old = _again(world, fault) if fault.word == AGAIN else _old(world, fault)
    if old is not None:
        world.publish(old)


@kind(targets=targets.boards, weight=0.5)
def foreign_halt(world: World, fault: Fault) -> None:
    """A stranger of an older epoch halts a board, which obeys a stop whoever says it."""
    numbers = _older(world, fault)
    if numbers is not None:
        halt = StopGoal(mode=StopMode.HALT, seq=numbers[1], epoch=numbers[0])
        world.publish(_published(fault, Channel.STOP, halt))


def _again(world: World, fault: Fault) -> Publication | None:
    last = world.obeyed.get(fault.target)
    if last is None or last.seq is None or (isinstance(last, StopGoal) and last.mode is not StopMode.CLEAR):
        return None
    return _published(fault, CHANNELS[type(last).__name__], last)


def _old(world: World, fault: Fault) -> Publication | None:
    numbers = _older(world, fault)
    if numbers is None:
        return None
    robot: Robot = targets.robot_of(world.model, fault.target)
    order = ORDERS[fault.word](world.model, robot.name, "", Dice(fault.seed, "order"))
    channel, goal = form_of(robot).goal(robot, order, epoch=numbers[0], seq=numbers[1])
    return _published(fault, channel, goal)


def _older(world: World, fault: Fault) -> tuple[int, int] | None:
    """The epoca and seq of a giver that the board obeys no more; None if it has carried out nothing."""
    last = world.obeyed.get(fault.target)
    if last is None or last.epoch is None or last.seq is None or last.epoch < 1:
        return None
    dice = Dice(fault.seed, "numbers")
    if last.epoch < (world.boards[fault.target].least_epoch or 0) and dice.chance(0.5):
        return last.epoch, last.seq + 1 + dice.below(4)
    if last.seq > 1 and dice.chance(0.5):
        return last.epoch, last.seq - 1 - dice.below(last.seq - 1)
    return last.epoch - 1 - dice.below(last.epoch), last.seq + dice.below(4)


def _published(fault: Fault, channel: Channel, goal: Goal) -> Publication:
    return Publication(topic=topic(fault.target, channel), payload=encode(goal))


CHANNELS = {
    "JointsGoal": Channel.JOINTS,
    "PathGoal": Channel.PATH,
    "EffectorGoal": Channel.EFFECTOR,
    "StopGoal": Channel.STOP,
    "HomeGoal": Channel.HOME,
    "VerbGoal": Channel.ORDER,
}

KINDS = (
    foreign_garbage,
    foreign_report,
    foreign_repeat,
    foreign_stray,
    foreign_retained,
    foreign_old,
    foreign_halt,
)
