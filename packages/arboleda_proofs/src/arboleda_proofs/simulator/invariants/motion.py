"""Invariants of motion, by what was asked for and where robots truly are."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.drivers import FollowPath, MoveJoints
from arboleda.wire.hop import shown
from arboleda.wire.payloads import JointsGoal, PathGoal, StopGoal

from ..truth.arm import ArmTruth
from ..truth.robot import RobotTruth
from .done import DONE
from .invariant import Look, Trigger, invariant


@invariant(Trigger.EXECUTED)
def no_unhomed_move(look: Look) -> Iterator[str]:
    """No board that lost its position, and does not claim otherwise, makes an absolute move before homing."""
    for robot in look.truth.changed:
        for act in robot.acts:
            absolute = isinstance(act.goal, JointsGoal | PathGoal)
            if absolute and not act.homed and not robot.robot.assume_homed:
                yield f"{robot.robot.name} is not homed and carries out {act.goal}"


@invariant(Trigger.SENT)
def no_move_after_a_boot_that_was_told(look: Look) -> Iterator[str]:
    """A robot whose board reports no homing gets no absolute move once the plant has heard that it booted."""
    boots = look.truth.boots
    for command in look.moment.sent if boots.mute else ():
        if isinstance(command, MoveJoints | FollowPath) and boots.is_known(command.robot):
            yield f"{command.robot} booted and was not put right since, but gets {shown(command)}"


@invariant(Trigger.CHANGED)
def nothing_moves_unasked(look: Look) -> Iterator[str]:
    """A body moves, and a fact of it changes, only by a goal that our bridge published, or to a stop."""
    for robot in look.truth.changed:
        yield from _moves_unasked(robot)
    for each in look.truth.grips.switched:
        if not (each.by_command or each.lost_power or each.by_others):
            yield f"the effector of {each.arm} goes {'on' if each.on else 'off'} unasked"


@invariant(Trigger.CHANGED)
def arm_stays_within_limits(look: Look) -> Iterator[str]:
    """No joint of a homed arm rests beyond its limits by more than lost steps and the end of a ramp."""
    for robot in look.truth.changed:
        # one that is not homed may stand where lost steps have taken it
        if isinstance(robot, ArmTruth) and robot.homed and not robot.moving and robot.outside is not None:
            joint = robot.outside
            yield f"{robot.robot.name} stands with {joint} beyond its limits, at {robot.true} motor steps"


def _moves_unasked(robot: RobotTruth) -> Iterator[str]:
    name = robot.robot.name
    for act in robot.acts:
        if not act.ours and not isinstance(act.goal, StopGoal):
            yield f"{name} carries out {act.goal}, which our bridge did not publish"
    if robot.started or robot.swerved:
        yield f"{name} {'begins to move' if robot.started else 'changes its way'} unasked"
    if robot.jumped:
        yield f"{name} is elsewhere and never moved"


MOTION = (
    no_unhomed_move,
    no_move_after_a_boot_that_was_told,
    nothing_moves_unasked,
    arm_stays_within_limits,
    *DONE,
)
