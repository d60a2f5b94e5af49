"""The wire: what leaves the bridge, what boards carry out, and that positions are what boards have told."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Any

from arboleda.drivers import (
    Command,
    Evidence,
    FollowPath,
    Grid,
    Home,
    Joint,
    MoveJoints,
    Robot,
    SetEffector,
    Stop,
    StopMode,
)
from arboleda.engine.inspection import beliefs_of
from arboleda.model.messages import Heartbeat
from arboleda.wire.payloads import StopGoal

from ..recorded.boards import fields, is_number, on_wire
from ..recorded.lateness import SLOW_S
from .invariant import Look, Trigger, invariant

LIMIT_BYTES = 512
FRESH_S = 2.0
ROUNDING_S = 1e-5
ROUNDING_DEG = 0.6e-4  # the wire has four decimals


@invariant(Trigger.EXECUTED)
def executed_numbers_rise(look: Look) -> Iterable[str]:
    """The (epoca, seq) of the commands that a board carries out rise from its boot on."""
    for board, goal, before, *_ in look.record.boards.executed:
        if before is not None and goal.seq is not None and (goal.epoch, goal.seq) <= before:
            yield f"{board} carried out {(goal.epoch, goal.seq)} after {before}"


@invariant(Trigger.EXECUTED)
def no_repeat_has_effect(look: Look) -> Iterable[str]:
    """A board carries out only what was delivered to it, each message once, and nothing retained."""
    for each in look.record.boards.executed:
        if not each.delivered:
            yield f"{each.board} carried out {each.goal}, which was not delivered anew"


@invariant(Trigger.EXECUTED)
def nothing_of_an_old_epoch_has_effect(look: Look) -> Iterable[str]:
    """A board that has heard a bridge beat carries out nothing of one before it."""
    for board, goal, _, _, beat, _ in look.record.boards.executed:
        if beat is not None and goal.epoch is not None and goal.epoch < beat:
            yield f"{board} carried out {(goal.epoch, goal.seq)} after a beat of {beat}"


@invariant(Trigger.EXECUTED)
def nothing_late_has_effect(look: Look) -> Iterable[str]:
    """A board carries out no command, but for a stop, whose giver had not heard it for FRESH_S by then."""
    for board, goal, *_, reported_at in look.record.boards.executed:
        if isinstance(goal, StopGoal) or goal.heard is None:
            continue
        if reported_at is None or look.world.now - reported_at > FRESH_S + ROUNDING_S:
            when = "unknown" if reported_at is None else f"{look.world.now - reported_at:.3f} s old"
            yield f"{board} carried out {goal}, which names telemetry that is {when}"


@invariant(Trigger.COMMANDED)
def commands_say_what_was_heard(look: Look) -> Iterable[str]:
    """A command names telemetry that the plant had just heard of its board: in this step, or last before."""
    for sent in look.record.commands.new:
        robot, command = look.record.robots[sent.command.robot], sent.command
        now = sum(said.robot == command.robot and said.number is not None for said in look.moment.reports)
        if not isinstance(command, Stop) and command.heard not in [*robot.numbers][-now - 1 :]:
            yield f"{sent} names telemetry {command.heard}, and the last was {robot.numbers[-1]}"


@invariant(Trigger.ORDERED)
def wire_targets_legal(look: Look) -> Iterable[str]:
    """Goals on the wire are finite, inside limits, whole motor steps, and what the plant commanded."""
    for publication in look.moment.ordered:
        if publication.topic.endswith(("/juntas", "/camino")):
            name, _, channel = publication.topic.partition("/")
            body = fields(publication.payload)
            yield from _path(look, name, body) if channel == "camino" else _joints(look, name, body)


def _joints(look: Look, name: str, body: Mapping[str, Any]) -> Iterator[str]:
    board = look.record.boards.by_name[name]
    arm = board.robot
    assert arm.joints
    goal: list[Any] = [body.get(f"q{number}") for number in range(1, len(arm.joints) + 1)]
    if not all(is_number(value) for value in goal) or not _numbered(arm.evidence, body):
        yield f"{name}/juntas is {body}"
        return
    if (held := tuple(goal)) not in board.legal:
        for joint, value in zip(arm.joints, goal, strict=True):
            yield from _off_step(name, joint, value)
        board.legal.add(held)
    recent = reversed(look.record.commands.goals.get(arm.name, ()))
    if not any(isinstance(each, MoveJoints) and _is_goal(arm, each.q, goal) for each in recent):
        yield f"{name}/juntas is {goal}, which the plant has not commanded"


def _off_step(name: str, joint: Joint, value: float) -> Iterator[str]:
    step = on_wire(joint, joint.step)
    if abs(value - round(value / step) * step) > ROUNDING_DEG:
        yield f"{name}: {joint.name} {value} is no whole motor step of {step}"
    # a limit between two motor steps is reached at the step nearest to it
    lower = on_wire(joint, min(joint.lower, joint.quantised(joint.lower))) - ROUNDING_DEG
    upper = on_wire(joint, max(joint.upper, joint.quantised(joint.upper))) + ROUNDING_DEG
    if not lower <= value <= upper:
        yield f"{name}: {joint.name} {value} is beyond {lower:.4f} to {upper:.4f}"


def _is_goal(arm: Robot, q: tuple[float, ...], goal: list[Any]) -> bool:
    rows = zip(arm.joints, q, goal, strict=True)
    return all(abs(on_wire(j, q) - said) <= on_wire(j, j.step) / 2 + ROUNDING_DEG for j, q, said in rows)


def _path(look: Look, name: str, body: Mapping[str, Any]) -> Iterator[str]:
    board = look.record.boards.by_name[name]
    mobile = board.robot
    assert mobile.floor_grid
    nodes: Any = body.get("nodos")
    whole = isinstance(nodes, list) and nodes and all(type(node) is int for node in nodes)
    if not whole or not _numbered(mobile.evidence, body):
        yield f"{name}/camino is {body}"
        return
    if (way := tuple(nodes)) not in board.legal:
        yield from _off_grid(name, mobile.floor_grid, nodes)
        board.legal.add(way)
    recent = reversed(look.record.commands.goals.get(mobile.name, ()))
    if not any(isinstance(each, FollowPath) and list(each.nodes) == nodes for each in recent):
        yield f"{name}/camino is {nodes}, which the plant has not commanded"


def _off_grid(name: str, grid: Grid, nodes: list[int]) -> Iterator[str]:
    if not all(0 <= node < grid.size for node in nodes):
        yield f"{name}/camino leaves the grid: {nodes}"
    elif any(there not in grid.neighbours(here) for here, there in pairwise(nodes)):
        yield f"{name}/camino leaves the grid's edges: {nodes}"


def _numbered(evidence: Evidence, body: Mapping[str, Any]) -> bool:
    stamps = [body.get("seq"), body.get("epoca")]
    if evidence is not Evidence.IDS:
        return stamps == [None, None]
    return all(type(stamp) is int and stamp > 0 for stamp in stamps)


@invariant(Trigger.PUBLISHED)
def nothing_retained_on_commands(look: Look) -> Iterable[str]:
    """Of all that the bridge and the boards publish, only presence is retained."""
    for client, publication in look.moment.published:
        if publication.retain and client and not publication.topic.endswith("/conexion"):
            yield f"{client} published {publication.topic} retained"


@invariant(Trigger.PUBLISHED)
def payload_size(look: Look) -> Iterable[str]:
    """No payload of the bridge or of a board is longer than 512 bytes."""
    for client, publication in look.moment.published:
        if len(publication.payload) > LIMIT_BYTES and client:
            yield f"{client} published {len(publication.payload)} bytes on {publication.topic}"


@invariant(Trigger.HEARD)
def published_joints_are_reported(look: Look) -> Iterable[str]:
    """A position that the plant shows is the last one it heard, and its board told it lately."""
    boards, beliefs = look.record.boards.of_robot, beliefs_of(look.world.plant)
    for report in look.moment.reports:
        if report.robot in boards:
            known, belief = look.record.robots[report.robot], beliefs[report.robot]
            if belief.q != known.q or belief.node != known.node:
                yield f"{report.robot} is shown at {belief.position}, and said {known.q or known.node}"
    if look.record.heard.anew:
        yield from _untold(look)


def _untold(look: Look) -> Iterator[str]:
    record = look.record
    for report in record.heard.anew:
        where = report.node if report.q is None else report.q
        board = record.boards.of_robot.get(report.robot)
        if where is None or board is None:
            continue
        if board.has_reported(report.q, report.node, record.lateness.reports_from_s(report.at)):
            continue
        if board.remembers(report.at - SLOW_S):  # else the plant waited longer for its disk than that
            yield f"{report.robot} is reported at {where}, which its board has not told lately"


@invariant(Trigger.BORN)
def nothing_shown_before_heard(look: Look) -> Iterable[str]:
    """A plant that starts shows no position of a robot that it has not heard."""
    beliefs, robots = beliefs_of(look.world.plant), look.record.robots
    wrong = (name for name, belief in beliefs.items() if belief.position is not None)
    return [f"{name} is shown without a word of it" for name in wrong if not _has_place(robots[name])]


def _has_place(known: Any) -> bool:
    return known.q is not None or known.node is not None


@invariant(Trigger.ORDERED)
def bridge_obeys_only_its_plant(look: Look) -> Iterable[str]:
    """Each motion, effector and clear that the bridge publishes is one command with an id that it took in, or
    one of others where it had heard no plant for so long that it obeys anybody.
    """
    taken = [each.message for each in look.moment.taken if not isinstance(each.message, Heartbeat)]
    given = [command for command in taken if command.id] + look.record.bridges.of_others
    for publication in look.moment.ordered:
        name, _, channel = publication.topic.partition("/")
        obeyed = _commanded(channel, fields(publication.payload))
        robot = look.record.boards.by_name[name].robot.name
        if obeyed is None:
            continue
        match = next((each for each in given if each.robot == robot and obeyed(each)), None)
        if match is None:
            yield f"{publication.topic} is {publication.payload!r}, which no command with an id asked for"
        else:
            given.remove(match)


def _commanded(channel: str, body: Mapping[str, Any]) -> Callable[[Command], bool] | None:
    """The test for the command that a message of the bridge carries; None for a message that needs none."""
    if channel == "juntas":
        return lambda command: isinstance(command, MoveJoints)
    if channel == "camino":
        return lambda command: isinstance(command, FollowPath)
    if channel == "referencia":
        return lambda command: isinstance(command, Home)
    if channel == "efector":
        return lambda command: isinstance(command, SetEffector) and command.on == body.get("efector")
    if channel == "orden":
        return lambda command: command.given.get("verb") == body.get("verbo")
    if channel == "paro" and body.get("paro") == StopMode.CLEAR:
        return lambda command: isinstance(command, Stop) and command.mode is StopMode.CLEAR
    return None


WIRE = (
    bridge_obeys_only_its_plant,
    executed_numbers_rise,
    no_repeat_has_effect,
    nothing_of_an_old_epoch_has_effect,
    nothing_late_has_effect,
    commands_say_what_was_heard,
    wire_targets_legal,
    nothing_retained_on_commands,
    payload_size,
    published_joints_are_reported,
    nothing_shown_before_heard,
)
