"""Faults in a board's telemetry: a field that sticks, a field that lies, bytes that make no sense."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, cast

from arboleda.drivers import Evidence, Joint, Jointed, MotionState, Robot
from arboleda.model.plant_model import PlantModel
from arboleda.rig.world import World
from arboleda.wire.units import to_wire

from ..chance import Dice
from . import targets
from .false_telemetry import Fields, alter, deceive, retold
from .kind import End, Fault, all_alike, kind, words

ABOUT = {
    "nodo": ("node",),
    "estado": ("state",),
    "seq": ("seq",),
    "epoca_ack": ("ack", "done"),  # of which epoch those numbers are
    "ack": ("ack",),
    "hecho": ("done",),
    "arranque": ("boot",),
    "ref": ("homed",),
    "efector": ("effector",),
    "pieza": ("piece",),
}
NUMBERED = ("seq", "epoca_ack", "ack", "hecho", "arranque")
HELD = ("efector", "pieza")
CODES = tuple(state.value for state in MotionState if state is not MotionState.NO_LINK)
Lie = Callable[[Fields], Any]  # the telemetry as it should be -> the value that is told instead


def fields_of(model: PlantModel, target: str) -> tuple[str, ...]:
    """The keys of a board's telemetry that are evidence, at its robot's level."""
    robot = targets.robot_of(model, target)
    place = tuple(_keys(robot)) if robot.joints else ("nodo",) if robot.floor_grid else ()
    if robot.evidence is not Evidence.IDS:
        return (*place, "estado")
    homed = ("ref",) if robot.homes else ()
    return (*place, "estado", *NUMBERED, *homed, *(HELD if robot.joints and robot.has_effector else ()))


def _any_joint(word: str) -> str:
    """One name for all joints: the plant asks the same of each."""
    return "q" if word[0] == "q" else word


@kind(targets=targets.boards, words=fields_of, seconds=(0.5, 15.0), alike=_any_joint)
def stuck_bit(world: World, fault: Fault) -> End:
    """A field of a board's telemetry keeps the value it has."""
    kept: Fields = {}

    def stick(fields: Fields) -> Fields:
        if fault.word in fields:
            kept.setdefault(fault.word, fields[fault.word])
        return {**fields, **kept}

    return deceive(world, fault.target, _about(fault.word), stick)


def _lies_of(model: PlantModel, target: str) -> tuple[str, ...]:
    return tuple(word for word in fields_of(model, target) if word[0] == "q" or word in LIES)


@kind(
    targets=targets.boards,
    words=_lies_of,
    seconds=(0.3, 10.0),
    amount=(2.0, 40.0),
    alike=_any_joint,
)
def lying_telemetry(world: World, fault: Fault) -> End:
    """A field of a board's telemetry is not true; `amount` is how many tolerances a joint is told off."""
    word = fault.word
    lie = _off(world, fault) if word[0] == "q" else LIES[word](world, fault)
    tells = {word, "ack"} if word == "hecho" else {word}  # done may be told before anything was
    return deceive(
        world,
        fault.target,
        _about(word),
        lambda fields: {**fields, word: lie(fields)} if tells & fields.keys() else fields,
    )


@kind(
    targets=targets.boards,
    words=words("half", "no number", "a truth value", "too long", "incomplete"),
    seconds=(0.2, 10.0),
    amount=(0.1, 1.0),
    alike=all_alike,
)
def garbled_telemetry(world: World, fault: Fault) -> End:
    """A share of `amount` of a board's telemetry cannot be read."""
    dice = Dice(fault.seed, "garbled")
    garble = GARBLES[fault.word]
    return alter(world, fault.target, lambda raw: garble(raw) if dice.chance(fault.amount) else raw)


def _about(word: str) -> tuple[str, ...]:
    return ("q",) if word[0] == "q" else ABOUT[word]


def _keys(arm: Robot) -> dict[str, tuple[Joint, float]]:
    """The joints of an arm and their tolerances by the keys that its telemetry has for them."""
    rows = zip(arm.joints, cast(Jointed, arm).motion.tolerances, strict=True)
    return {f"q{number}_mov": row for number, row in enumerate(rows, start=1)}


def _off(world: World, fault: Fault) -> Lie:
    arm = targets.robot_of(world.model, fault.target)
    assert arm.joints
    joint, tolerance = _keys(arm)[fault.word]
    sign = Dice(fault.seed, "sign").pick((-1.0, 1.0))
    off = sign * fault.amount * to_wire(joint, tolerance)
    return lambda fields: round(fields[fault.word] + off, 4)


def _another(fault: Fault, now: int, choices: Sequence[int]) -> Lie:
    other = Dice(fault.seed, "other").pick([each for each in choices if each != now])
    return lambda fields: other


def _other_code(world: World, fault: Fault) -> Lie:
    homes = targets.robot_of(world.model, fault.target).homes
    codes = [code for code in CODES if homes or code != MotionState.NOT_HOMED.value]
    return _another(fault, world.boards[fault.target].state.value, codes)


def _other_node(world: World, fault: Fault) -> Lie:
    robot = targets.robot_of(world.model, fault.target)
    assert robot.floor_grid
    node = world.boards[fault.target].body.tell().node
    return _another(fault, -1 if node is None else node, range(robot.floor_grid.size))


def _other_number(world: World, fault: Fault) -> Lie:
    """A number near that of the last command, or that number itself: `hecho` then says done too early."""
    own = fault.word == "ack"
    beside = Dice(fault.seed, "beside").pick((-1, 1, 1000) if own else (-1, 0, 0, 1, 1000))
    return lambda fields: max(0, fields.get("ack", 0) + beside)


def _other_boot(world: World, fault: Fault) -> Lie:
    beside = 1000 + Dice(fault.seed, "boot").below(1000)
    return lambda fields: fields["arranque"] + beside


def _old_seq(world: World, fault: Fault) -> Lie:
    """The same number several times over."""
    times = 2 + Dice(fault.seed, "seq").below(30)
    return lambda fields: fields["seq"] - fields["seq"] % times


LIES: dict[str, Callable[[World, Fault], Lie]] = {
    "estado": _other_code,
    "nodo": _other_node,
    "hecho": _other_number,
    "ack": _other_number,
    "ref": lambda world, fault: lambda fields: 0,
    "arranque": _other_boot,
    "seq": _old_seq,
    "efector": lambda world, fault: lambda fields: 1 - fields["efector"],
}

GARBLES: dict[str, Callable[[bytes], bytes]] = {
    "half": lambda raw: raw[: len(raw) // 2],
    "no number": lambda raw: retold(raw, lambda fields: {**fields, next(iter(fields)): math.nan}),
    "a truth value": lambda raw: retold(raw, lambda fields: {**fields, "estado": True}),
    "too long": lambda raw: retold(raw, lambda fields: {**fields, "x": "x" * 600}),
    "incomplete": lambda raw: retold(raw, lambda fields: {key: fields[key] for key in list(fields)[1:]}),
}

KINDS = (stuck_bit, lying_telemetry, garbled_telemetry)
