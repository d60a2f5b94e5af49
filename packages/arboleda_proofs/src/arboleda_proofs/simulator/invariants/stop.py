"""Invariants of a stop (software), by what truly moves."""

from __future__ import annotations

from collections.abc import Iterator

from .invariant import Look, Trigger, invariant


@invariant(Trigger.EXECUTED)
def latched_board_stays_still(look: Look) -> Iterator[str]:
    """No board that obeyed a latching stop starts a motion or grips until it is cleared."""
    for robot in look.truth.changed:
        for act in robot.acts:
            if act.latched and act.starts:
                yield f"{robot.robot.name} is stopped (latched) and carries out {act.goal}"


@invariant(Trigger.EXECUTED)
def stop_holds(look: Look) -> Iterator[str]:
    """After an operator's stop no robot of its scope moves or grips anew until it is cleared and reset."""
    for robot, act in look.truth.defied:
        yield f"{robot} was stopped by an operator and carries out {act.goal}"


@invariant(Trigger.CHANGED)
def speed_never_rises_after_stop(look: Look) -> Iterator[str]:
    """From the moment a board hears a stop or halt nothing of it gets faster, and it rests after its ramp."""
    for robot in look.truth.changed:
        if robot.sped_up:
            yield f"{robot.robot.name} was told to stop and gets faster"
        if robot.runs_on:
            yield f"{robot.robot.name} was told to stop and drives on"


STOP = (latched_board_stays_still, stop_holds, speed_never_rises_after_stop)
