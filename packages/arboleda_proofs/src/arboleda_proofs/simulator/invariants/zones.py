"""Shared zones, by where robots and devices truly are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import dropwhile

from py_trees.common import Status

from arboleda.drivers import Evidence, MoveJoints, Position
from arboleda.engine import CellRun, State, TakeDevices, TakeZones
from arboleda.model.cell_states import CellState
from arboleda.model.plant_model import Cell, Pose, Workspace
from arboleda.recipes import Sentence

from ..recorded.commands import SentCommand
from ..recorded.zone_users import ZoneUser
from .invariant import Look, Trigger, invariant

EVERY_S = 1.0


@invariant(Trigger.MET)
def one_robot_per_zone(look: Look) -> Iterator[str]:
    """At most one robot or device is in a shared zone, or may have swept it, unless an operator said else."""
    for meeting in look.truth.zones.meetings:
        theirs = [name for name in meeting.arms if name not in meeting.excused]
        theirs = [name for name in theirs if not look.truth.mistaken(look.truth.robots[name])]
        if len(theirs) > 1:
            yield f"{' and '.join(theirs)} are in zone {meeting.zone}"


@invariant(Trigger.FREED)
def zone_released_only_outside(look: Look) -> Iterator[str]:
    """The plant frees a zone only if who had it is truly outside, or on an operator's override."""
    for freed in look.truth.zones.freed:
        who = look.truth.robots.get(freed.arm)
        if who is not None and freed.zone in who.zones and not freed.by_hand and not look.truth.mistaken(who):
            yield f"zone {freed.zone} is taken from {freed.arm}, which is still in it"


@invariant(Trigger.ENTERED)
def zone_entered_only_when_held(look: Look) -> Iterator[str]:
    """A robot that gets into a shared zone does so only while the plant keeps that zone for it."""
    for entry in look.truth.zones.entries:
        kept_for = entry.holder or "nobody"
        if kept_for != entry.arm and not look.truth.mistaken(look.truth.robots[entry.arm]):
            yield f"{entry.arm} enters zone {entry.zone}, which the plant keeps for {kept_for}"


@invariant(Trigger.FREED, every_s=EVERY_S)
def a_wait_names_its_cause(look: Look) -> Iterator[str]:
    """A step that waits for zones or for shared devices says why, and names who has one of them now."""
    for run in look.world.plant.cells.values():
        if run.tree is not None and run.state is CellState.EXECUTE:
            yield from _silent_waits(look, run)


def _silent_waits(look: Look, run: CellRun) -> Iterator[str]:
    name = run.cell.name
    for node in run.run.nodes:
        if node.status is not Status.RUNNING or not isinstance(node, TakeZones | TakeDevices):
            continue
        asks = (node.robot, node.zones) if isinstance(node, TakeZones) else (name, node.devices)
        holders = {look.world.plant.zones.holder(each) for each in asks[1]} - {None, asks[0]}
        if not node.feedback:
            yield f"{name} waits in {node.name} and does not say for what"
        elif holders and holders.isdisjoint(_named(node.feedback)):
            yield f"{name} {node.feedback}, and {', '.join(sorted(map(str, holders)))} has it"


@invariant(Trigger.COMMANDED)
def recovery_takes_its_zones(look: Look) -> Iterator[str]:
    """A robot that recovers from where nobody knows moves only while it holds all that its way may cross."""
    for sent in look.record.commands.new:
        cell = look.record.cells[sent.entry.cell] if sent.entry else None
        user = None if cell is None else cell.zone_users.get(sent.robot)
        if cell is None or user is None or cell.run.task is None or not cell.run.run.recovering:
            continue
        if isinstance(sent.command, MoveJoints) and not user.held_before:
            yield from _lacking(look, cell.cell, user, sent, sent.command.q)


def _lacking(look: Look, cell: Cell, user: ZoneUser, sent: SentCommand, goal: Position) -> Iterator[str]:
    """The zones that a robot does not hold as it sets out; it may hold those of any of its ways."""
    backs = _backs(cell, user.space)
    if not _sets_out(user, backs, goal) or _is_known_outside(look, user.space):
        return
    held = look.world.plant.zones.held_by(user.robot)
    ways = [pose for pose in backs if goal in (pose.q, pose.above)] or backs
    lacking = min((_of_any_way(user.space, pose) - held for pose in ways), key=len)
    if lacking:
        yield f"{sent} leaves from an unknown place without zone {', '.join(sorted(lacking))}"


def _backs(cell: Cell, space: Workspace) -> tuple[Pose, ...]:
    """The poses to which a recovery may bring a part: what was brought goes back to the handover."""
    if cell.handover is not None and cell.handover.taker == space.robot.name:
        return space.at(cell.handover.targets)
    return space.poses


def _of_any_way(space: Workspace, back: Pose) -> frozenset[str]:
    """The zones of a pose and home, and of every move that leads there."""
    ends = {back.name, space.home.name}
    crossed = (each.zones for each in space.crossings if {each.a, each.b} & ends)
    return back.zones.union(space.home.zones, *crossed)


def _sets_out(user: ZoneUser, backs: Sequence[Pose], goal: Position) -> bool:
    """True if this move is the first of its recovery after it took its zones, or repeats that one.

    With approach heights the robot rises first: its first move, and all that repeat that one, do not count.
    """
    moves = user.moves
    if any(pose.above for pose in user.space.poses):
        moves = [*dropwhile(lambda each: each.state is not State.DONE, moves)][1:]
    goals = [each.command.q for each in moves if isinstance(each.command, MoveJoints)]
    ends = [user.space.home.q, *(spot for each in backs for spot in (each.q, each.above))]
    return [each for each in goals if each in ends] == [goal]


def _is_known_outside(look: Look, space: Workspace) -> bool:
    """True if a robot was last seen at, or above, a pose outside of all zones; at `state` nobody sees it."""
    robot, q = space.robot, look.record.robots[space.robot.name].q
    if robot.evidence is Evidence.STATE:
        return True
    return q is not None and any(robot.motion.stands_at(q, spot) for spot, _ in space.free_spots)


def _named(sentence: Sentence) -> set[object]:
    return {each for each in sentence.values.values() if isinstance(each, str)}


ZONES = (
    one_robot_per_zone,
    zone_released_only_outside,
    zone_entered_only_when_held,
    a_wait_names_its_cause,
    recovery_takes_its_zones,
)
