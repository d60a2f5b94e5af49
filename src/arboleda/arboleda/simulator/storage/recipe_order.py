"""Invariants of work: commands follow the recipe in its order; a recovery holds its way's zones."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import dropwhile

from arboleda.dispatch.ledger import State
from arboleda.kinds.arm import Arm
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Position
from arboleda.model.plant_model import Evidence, Pose
from arboleda.recipes.storage_layout import StorageLayout

from ..invariants.invariant import Look, Trigger, invariant
from ..recorded.cells import KnownCell
from ..recorded.commands import SentCommand
from .tasks import NAMES, stores


@invariant(Trigger.NEWS)
def commands_follow_the_recipe(look: Look) -> Iterable[str]:
    """A task commands what its shipped recipe says, each step after the one before is done, and all of it."""
    return look.record.works.wrong if look.world.recipes is None else ()


@invariant(Trigger.COMMANDED)
def recovery_takes_its_zones(look: Look) -> Iterator[str]:
    """An arm that recovers from where nobody knows moves only while it holds all that its way may cross."""
    for sent in look.record.commands.new:
        cell = look.record.cells[sent.entry.cell] if sent.entry else None
        if cell is None or not isinstance(sent.command, MoveJoints) or not _at_storage(look, cell):
            continue
        if cell.run.run.recovering and _sets_out(cell, sent) and not _is_known_outside(look, cell.layout):
            yield from _lacking(look, cell, sent)


def _at_storage(look: Look, cell: KnownCell) -> bool:
    """True if a cell whose arm shares zones is at a task of a storage recipe."""
    task = cell.run.task
    if task is None or not stores(cell.cell) or task.order.recipe not in NAMES:
        return False
    return bool(cell.layout.space.zones)


def _lacking(look: Look, cell: KnownCell, sent: SentCommand) -> Iterator[str]:
    held = look.world.plant.zones.held_by(cell.layout.arm.name)
    if cell.held_before_recovery:
        return  # it stands in zones that it holds already
    pickups = cell.layout.pickups
    goals = [pickup for pickup in pickups if _goal(sent) in (pickup.q, pickup.above)] or pickups
    lacking = min((_of_any_way(cell.layout, pickup) - held for pickup in goals), key=len)
    if lacking:
        yield f"{sent} leaves from an unknown place without zone {', '.join(sorted(lacking))}"


def _of_any_way(cell: StorageLayout, pickup: Pose) -> frozenset[str]:
    """The zones of a pick-up and home, and of every move that leads there."""
    ends = {pickup.name, cell.home.name}
    crossed = (each.zones for each in cell.space.crossings if {each.a, each.b} & ends)
    return pickup.zones.union(cell.home.zones, *crossed)


def _sets_out(cell: KnownCell, sent: SentCommand) -> bool:
    """True if this move is the first of its recovery after it took its zones, or repeats that one.

    With approach heights the arm rises first: its first move, and all that repeat that one, do not count.
    """
    moves = cell.recovery_moves
    if any(pose.above for pose in cell.layout.space.poses):
        moves = [*dropwhile(lambda each: each.state is not State.DONE, moves)][1:]
    goals = [each.command.q for each in moves if isinstance(each.command, MoveJoints)]
    ends = [cell.layout.home.q, *(spot for each in cell.layout.pickups for spot in (each.q, each.above))]
    return [goal for goal in goals if goal in ends] == [_goal(sent)]


def _goal(sent: SentCommand) -> Position:
    """The goal of an arm's motion."""
    assert isinstance(sent.command, MoveJoints)
    return sent.command.q


def _is_known_outside(look: Look, cell: StorageLayout) -> bool:
    """True if the arm was last seen at, or above, a pose outside of all zones; at `state` nobody sees it."""
    arm, q = cell.arm, look.record.robots[cell.arm.name].q
    if arm.evidence is Evidence.STATE:
        return True
    spots = [spot for pose in cell.space.poses if not pose.zones for spot in (pose.q, pose.above) if spot]
    goals = (*(spot for spot in spots if isinstance(spot, tuple)), (0.0,) * len(arm.joints))
    return q is not None and any(_near(arm, q, goal) for goal in goals)


def _near(arm: Arm, q: tuple[float, ...], goal: tuple[float, ...]) -> bool:
    tolerances = arm.tolerance or [joint.step / 2 + 1e-5 for joint in arm.joints]
    rows = zip(arm.joints, q, goal, tolerances, strict=True)
    return all(abs(at - to) <= off + joint.step / 2 + 1e-9 for joint, at, to, off in rows)


WORK = (commands_follow_the_recipe, recovery_takes_its_zones)
