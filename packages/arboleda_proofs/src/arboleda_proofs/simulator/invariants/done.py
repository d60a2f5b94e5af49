"""Invariants of commands that the plant calls done, by the true places of robots and states of effectors."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.drivers import Command, Evidence, FollowPath, Home, MoveJoints, SetEffector

from ..truth.arm import ArmTruth
from ..truth.ended_commands import EndedCommand
from ..truth.mobile import MobileTruth
from ..truth.robot import RobotTruth
from ..truth.truth import Truth
from .invariant import Look, Trigger, invariant


@invariant(Trigger.BOOKED)
def done_is_true(look: Look) -> Iterator[str]:
    """A command that the plant takes for done is truly done: the robot stands there, the effector is so."""
    for booked in look.truth.books.ended:
        if booked.done and (why := _untrue(look.truth, booked)):
            yield f"{_name(booked.command)} is called done, but {why}"


@invariant(Trigger.BOOKED)
def tiny_moves_succeed(look: Look) -> Iterator[str]:
    """A move that no fault and no operator touches is done, even one of no length."""
    for booked in look.truth.books.ended:
        if not booked.done and _undisturbed(look.truth, booked):
            failure = booked.entry.failure
            yield f"{_name(booked.command)} failed untouched: {failure.sentence if failure else 'no cause'}"


def _undisturbed(truth: Truth, booked: EndedCommand) -> bool:
    entry, robot = booked.entry, truth.robot(booked.command.robot)
    if robot is None or not entry.is_work or entry.cancelled_at is not None:
        return False
    return robot.homed and not robot.latched and truth.books.calm_since(booked.sent_at)


def _name(command: Command) -> str:
    return f"{type(command).__name__} {command.id} of {command.robot}"


def _untrue(truth: Truth, booked: EndedCommand) -> str | None:
    """The part of a command called done that is not true; None if all is true, or if nobody could know."""
    command, robot = booked.command, truth.robot(booked.command.robot)
    if robot is None or _unprovable(truth, booked, robot):
        return None
    if isinstance(command, SetEffector) and isinstance(robot, ArmTruth):
        ended_at = max(robot.booted_us / 1e6, robot.robbed_at)  # by a loss of power, or by somebody else
        lost = command.on and ended_at >= booked.sent_at  # it was on before, and is reported only now
        return None if lost or robot.on == command.on else f"it is {'on' if robot.on else 'off'}"
    if isinstance(command, MoveJoints) and isinstance(robot, ArmTruth):
        return None if robot.stands_at(command.q) else _where(robot, f"{robot.true} motor steps")
    if isinstance(command, FollowPath) and isinstance(robot, MobileTruth):
        return None if robot.stands_at(command.nodes[-1]) else _where(robot, f"node {robot.node}")
    if not isinstance(command, Home):
        return None
    return None if robot.at_reference else _where(robot, "another place than its reference")


def _where(robot: RobotTruth, place: str) -> str:
    return f"it {'moves' if robot.moving else 'stands'} at {place}"


def _unprovable(truth: Truth, booked: EndedCommand, robot: RobotTruth) -> bool:
    """True if a robot's reports prove nothing of a command, by its evidence or by lies.

    At `ids` a move shows in two ways, its number and the place, and both must be lies. At `joints` it shows
    in place and state: a boot without a trace makes them worthless, and so does a slow line, as nothing tells
    what was said before the command came. An effector does not show there at all. A robot that somebody has
    put at its reference by hand since then, and that is still there, may have been at the goal before.
    """
    evidence, place = robot.robot.evidence, "q" if isinstance(robot, ArmTruth) else "node"

    def lies(what: str) -> bool:
        return truth.deceived_since(robot.robot.mqtt, what, booked.sent_at)

    if isinstance(booked.command, SetEffector):
        return evidence is not Evidence.IDS or lies("effector")
    if isinstance(booked.command, Home):
        return lies("homed")
    if robot.blind:
        return True
    if robot.put_right_at >= booked.sent_at and robot.at_reference:
        return True
    if evidence is Evidence.IDS:
        return lies("done") and lies(place)
    return booked.late or lies(place) or lies("state")


DONE = (done_is_true, tiny_moves_succeed)
