"""Invariants of cells that are taught by hand: nothing moves there but what somebody holds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from arboleda.drivers import Home, Jointed, Motion, Robot, Stop
from arboleda.engine.inspection import HOLD_S, ledger_of
from arboleda.kinds.joints.motion import STRIDE_S
from arboleda.model.by_class import nearest
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.wire.hop import shown

from .invariant import Look, Trigger, invariant

STOPS_WITHIN_S = 0.3  # of a robot of joints whose teacher is lost
QUIET_S = 10.0  # after the last fault nothing is late any more
ROUNDING_S = 1e-6


@invariant(Trigger.SENT)
def nothing_is_told_to_move_in_manual_but_what_is_held(look: Look) -> Iterator[str]:
    """A robot of a cell that is taught gets no motion unless the plant has heard within `HOLD_S` that its
    button is held.
    """
    teachers = look.record.teachers
    if not (teachers.was and teachers.taught):
        return
    for command in look.moment.sent:
        if not isinstance(command, Motion) or isinstance(command, Stop):
            continue
        cells = {cell.name for cell in look.world.model.cells_of[command.robot]}
        if cells <= teachers.was.keys() & teachers.taught.keys():
            since = look.world.plant.now - teachers.held_at.get(command.robot, -math.inf)
            if since > HOLD_S + ROUNDING_S:
                yield f"{command.robot} gets {shown(command)}, and its button was held {since:.3f} s ago"


@invariant(Trigger.TOLD)
def no_task_begins_in_manual(look: Look) -> Iterator[str]:
    """No task begins to run in a cell that is taught."""
    taught = look.record.teachers.was.keys() & look.record.teachers.taught.keys()
    for message in look.moment.sent if taught else ():
        if isinstance(message, TaskChanged) and message.state is TaskState.RUNNING and message.cell in taught:
            yield f"task {message.task} begins in {message.cell}, which is taught"


@invariant(Trigger.TAUGHT)
def a_lost_teacher_stops_the_robot(look: Look) -> Iterator[str]:
    """A robot of joints of a cell that is taught stands 0.3 s after the plant last heard that its button is
    held, or after the longest of its short goals, where nothing has gone wrong for a while.
    """
    teachers, world = look.record.teachers, look.world
    calm = not world.faults_active and world.now >= world.last_fault_at + QUIET_S
    if not (look.record.step.stepped and calm):
        return
    for name in teachers.taught:
        cell = world.model.cell(name)
        for robot in cell.reached:
            longest = nearest(LONGEST_S, type(robot))
            if longest is None or robot.name in cell.shared:
                continue
            work = ledger_of(world.plant).work_of(robot.name)
            homes = work is not None and isinstance(work.command, Home)
            since = world.now - teachers.held_at.get(robot.name, math.inf)
            if not homes and since > longest(robot) and world.boards[robot.mqtt].body.moving:
                yield f"{robot.name} still moves {since:.3f} s after its button was held last"


def _longest_s(robot: Jointed) -> float:
    """The time within which a robot stands whose button is not held any more: a motor with large steps, or
    one that is seen only roughly, may need longer for the least that it can do.
    """
    rows = zip(robot.joints, robot.motion.tolerances, strict=True)
    least = max(joint.travel_s(max(joint.step, 2 * within)) for joint, within in rows)
    return STOPS_WITHIN_S + max(0.0, least - STRIDE_S)


LONGEST_S: dict[type[Robot], Callable[[Any], float]] = {Jointed: _longest_s}
TEACHING = (
    nothing_is_told_to_move_in_manual_but_what_is_held,
    no_task_begins_in_manual,
    a_lost_teacher_stops_the_robot,
)
