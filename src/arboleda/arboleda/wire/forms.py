"""Forms of commands and telemetry over MQTT for each type of robot."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from arboleda.kinds.arm import Arm, SetEffector
from arboleda.kinds.declared import Device, FactType, UseError, VerbCall
from arboleda.kinds.joints import Joint, Jointed, MoveJoints
from arboleda.kinds.mobile import FollowPath, Mobile
from arboleda.model import refusals
from arboleda.model.by_class import nearest
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.errors import PayloadError
from arboleda.model.facts import Facts
from arboleda.model.messages import Report
from arboleda.model.outside import quoted
from arboleda.model.plant_model import Robot
from arboleda.model.sentence import Phrase, Sentence

from .payloads import DEVICE, EffectorGoal, Goal, HomeGoal, JointsGoal, PathGoal, StopGoal, VerbGoal
from .topics import Channel
from .units import to_wire

FLOAT32_SLACK = 1e-6  # a goal at its limit comes back from a Float32MultiArray this far beyond it (rad, m)
ON_THE_GRID = Phrase(
    "why.on_the_grid", "a path begins at the robot's node or next to it, and follows the grid"
)
ELSEWHERE = Phrase("why.elsewhere", "it stands at node {node}, where a path may begin at one of {expected}")
NODES = Phrase("why.nodes", "its nodes are 0 to {last}")
BEYOND = Phrase("why.beyond", "number {number} is {value:.4g}; allowed: {lower:.4g} to {upper:.4g} {unit}")
DEGREES = Phrase("why.degrees", "degrees")
OTHER_UNIT = Phrase(
    "why.other_unit",
    "number {number} is {value:.4g}; allowed: {lower:.4g} to {upper:.4g} {unit}. Is it in {other}? "
    "In {unit} that is {meant:.4g}",
)
UNDONE = Phrase("why.undone", "it has not ended its last work, or is in fault")


@dataclass(frozen=True, kw_only=True)
class CommandForm:
    """Form of one class of commands: channel, payload, and the word that refuses a command."""

    channel: Channel
    goal: type[Goal]
    body: Callable[[Any, Any], dict[str, object]]
    refusal: Callable[[Any, Any], str | None] = lambda robot, command: None
    # The reason why a board without refusals ignores a command at the place where its robot rests.
    passed_over: Callable[[Any, Any, Report], Sentence | None] = lambda robot, command, report: None


@dataclass(frozen=True, kw_only=True)
class MessageForm:
    """Form of one robot's messages: the commands it takes, and the fields of its telemetry.

    `missing` has the words that refuse commands without a form, else `formato` does. `why` gives the sentence
    on a refusal, if there is more to say than its word.
    """

    command_forms: Mapping[type[Command], CommandForm]
    axes: int | None  # as `decode` wants it
    joints: tuple[Joint, ...] = ()
    nodes: int = 0
    facts: Mapping[str, FactType] = field(default_factory=dict)
    missing: Mapping[type[Command], str] = field(default_factory=dict)
    why: Callable[[Any, Any, str, bool], Sentence | None] = lambda robot, command, word, by_board: None

    def form_of_command(self, kind: type[Command]) -> CommandForm | None:
        """The form of a class of commands, or of its nearest base; None if neither has one."""
        return nearest(self.command_forms, kind)

    def refusal(self, robot: Robot, command: Command) -> str | None:
        """The word that refuses a command which the robot can never carry out; None if it can."""
        kind = type(command)
        command_form = self.form_of_command(kind)
        return (
            self.missing.get(kind, refusals.FORMAT)
            if command_form is None
            else command_form.refusal(robot, command)
        )

    def goal(self, robot: Robot, command: Command, **stamp: int | str | None) -> tuple[Channel, Goal]:
        """The channel and payload of a command that `refusal` accepted; `stamp` has its `seq` and `epoch`.

        For all commands but a stop, `stamp` also has `heard` and `token`.
        """
        command_form = self.form_of_command(type(command))
        assert command_form is not None
        return command_form.channel, command_form.goal(**command_form.body(robot, command), **stamp)  # type: ignore[arg-type]

    def facts_in(self, facts: Facts | None) -> Facts | None:
        """The facts of telemetry in the types of the kind; raises PayloadError for an invalid one."""
        return None if facts is None else tuple(self._fact(name, value) for name, value in facts)

    def _fact(self, name: str, value: object) -> tuple[str, Any]:
        type = self.facts.get(name)
        if type is None:
            names = ", ".join(self.facts) or "none"
            raise PayloadError(f"datos has {quoted(name)}; this device has {names}")
        read = type.read(value)
        if read is None:
            raise PayloadError(f"datos.{name} is {quoted(value)}; allowed: {type.allowed()}")
        return name, read


def form_of(robot: Robot) -> MessageForm:
    """The form of the robot's class, or of its nearest base."""
    form = nearest(FORMS, type(robot))
    if form is None:
        raise TypeError(f"{robot.name} is reached over no wire: nothing says how a {robot.kind_name} is told")
    return form(robot)


def _check_joints(robot: Jointed, command: MoveJoints) -> str | None:
    if len(command.q) != len(robot.joints) or not all(math.isfinite(value) for value in command.q):
        return refusals.FORMAT
    return refusals.LIMIT if _beyond(robot, command) else None


def _check_path(mobile: Mobile, command: FollowPath) -> str | None:
    if not command.nodes:
        return refusals.FORMAT
    inside = all(0 <= node < mobile.grid.size for node in command.nodes)
    return None if inside else refusals.LIMIT


def _begins_elsewhere(mobile: Mobile, command: FollowPath, report: Report) -> Sentence | None:
    if report.node is None:
        return None
    expected = sorted((report.node, *mobile.grid.neighbours(report.node)))
    if command.nodes[0] in expected:
        return None
    return ELSEWHERE(node=report.node, expected=", ".join(map(str, expected)))


def _check_order(device: Device, command: VerbCall) -> str | None:
    try:
        device.kind.command(id="", robot=device.name, verb=command.verb, values=dict(command.values))
    except UseError:
        return refusals.FORMAT
    return None


def _check_stop(robot: Robot, command: Stop) -> str | None:
    return None if robot.has_stop else refusals.NO_STOP


def _wire_joints(robot: Jointed, command: MoveJoints) -> dict[str, object]:
    rows = zip(robot.joints, robot.motion.quantised(command.q), strict=True)
    return {"q_deg": tuple(to_wire(joint, value) for joint, value in rows)}


def _beyond(robot: Jointed, command: MoveJoints) -> Sentence | None:
    """The first joint beyond its limits; None if there is none."""
    for number, (joint, value) in enumerate(zip(robot.joints, command.q, strict=True), start=1):
        if not joint.lower - FLOAT32_SLACK <= value <= joint.upper + FLOAT32_SLACK:
            return _out_of_limits(joint, number, value)
    return None


def _out_of_limits(joint: Joint, number: int, value: float) -> Sentence:
    """The sentence on a value beyond a joint's limits, which may be in degrees or mm by mistake."""
    lower, upper, unit = joint.lower, joint.upper, joint.unit
    other, meant = (DEGREES(), math.radians(value)) if unit == "rad" else ("mm", value / 1000)
    said = partial(OTHER_UNIT, other=other, meant=meant) if lower <= meant <= upper else BEYOND
    return said(number=number, value=value, lower=lower, upper=upper, unit=unit)


def _why_of_joints(robot: Jointed, command: Command, word: str, by_board: bool) -> Sentence | None:
    return _beyond(robot, command) if word == refusals.LIMIT and isinstance(command, MoveJoints) else None


def _why_of_mobiles(mobile: Mobile, command: Command, word: str, by_board: bool) -> Sentence | None:
    if word != refusals.LIMIT or not isinstance(command, FollowPath):
        return None
    return ON_THE_GRID() if by_board else NODES(last=mobile.grid.size - 1)


def _why_of_devices(device: Device, command: Command, word: str, by_board: bool) -> Sentence | None:
    return UNDONE() if word == refusals.BUSY else None


STOP = CommandForm(
    channel=Channel.STOP,
    goal=StopGoal,
    body=lambda robot, command: {"mode": StopMode(command.mode)},
    refusal=_check_stop,
)
HOME = CommandForm(channel=Channel.HOME, goal=HomeGoal, body=lambda robot, command: {})
OF_JOINTS: dict[type[Command], CommandForm] = {
    MoveJoints: CommandForm(
        channel=Channel.JOINTS, goal=JointsGoal, body=_wire_joints, refusal=_check_joints
    ),
    Stop: STOP,
    Home: HOME,
}
OF_ARMS: dict[type[Command], CommandForm] = {
    **OF_JOINTS,
    SetEffector: CommandForm(
        channel=Channel.EFFECTOR, goal=EffectorGoal, body=lambda robot, command: {"on": command.on}
    ),
}
OF_MOBILES: dict[type[Command], CommandForm] = {
    FollowPath: CommandForm(
        channel=Channel.PATH,
        goal=PathGoal,
        body=lambda robot, command: {"nodes": command.nodes},
        refusal=_check_path,
        passed_over=_begins_elsewhere,
    ),
    Stop: STOP,
    Home: HOME,
}
OF_DEVICES: dict[type[Command], CommandForm] = {
    VerbCall: CommandForm(
        channel=Channel.ORDER,
        goal=VerbGoal,
        body=lambda robot, command: {"verb": command.verb, "values": command.values},
        refusal=_check_order,
    ),
    Stop: STOP,
}


def _of_jointed(robot: Jointed) -> MessageForm:
    return MessageForm(
        command_forms=OF_JOINTS, axes=len(robot.joints), joints=robot.joints, why=_why_of_joints
    )


def _of_arm(arm: Arm) -> MessageForm:
    return replace(_of_jointed(arm), command_forms=OF_ARMS)


def _of_mobile(mobile: Mobile) -> MessageForm:
    return MessageForm(command_forms=OF_MOBILES, axes=None, nodes=mobile.grid.size, why=_why_of_mobiles)


def _of_device(device: Device) -> MessageForm:
    return MessageForm(
        command_forms=OF_DEVICES,
        axes=DEVICE,
        facts=device.kind.facts,
        missing={Home: refusals.NO_HOME},
        why=_why_of_devices,
    )


FORMS: dict[type[Robot], Callable[[Any], MessageForm]] = {
    Jointed: _of_jointed,
    Arm: _of_arm,
    Mobile: _of_mobile,
    Device: _of_device,
}
