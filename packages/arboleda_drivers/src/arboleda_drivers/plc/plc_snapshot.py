"""Values that a PLC shows at one moment, the report made of them, and values to be written."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from arboleda.drivers import DriverError, Facts, MotionState, Receipt, Report, Value

from .numbers import Numbers

STATES = {
    "stopped": MotionState.STOPPED,
    "moving": MotionState.MOVING,
    "fault": MotionState.FAULT,
    "latched": MotionState.STOP_LATCHED,
}
UNNAMED = "no reason given"
PLC_EPOCH = 0  # of the numbers that a PLC shows: they go on over all starts of the plant


W = TypeVar("W")


class UnreadableValue(DriverError):
    """Value of a PLC that has no meaning in the mapping."""


@dataclass(frozen=True, kw_only=True)
class PlcSnapshot:
    """Values of the PLC, read together: numbers of commands, words and facts; 0 and None mean no command."""

    state: str = "stopped"
    facts: Facts = ()
    boot: int | None = None
    accepted: int | None = None
    done: int | None = None
    rejected: int | None = None
    reason: str | None = None
    failed: int | None = None
    failure: str | None = None


@dataclass(frozen=True, kw_only=True)
class Question:
    """Last query, by its number, and the answer that the PLC shows now."""

    number: int
    answer: Value


@dataclass(frozen=True, kw_only=True)
class Writing(Generic[W]):
    """Values to write, one telegram after the other.

    `begins_last`: the device does nothing before the last one, so one that fails has begun nothing.
    """

    puts: tuple[W, ...]
    begins_last: bool


def report(
    robot: str, at: float, shown: PlcSnapshot, numbers: Numbers, question: Question | None = None
) -> Report:
    """The report of a device: numbers that were not given name no command.

    A query is done when it is answered, so the answer is that which was shown together with its number.
    """
    answered = question is not None and shown.done == question.number
    id, rejected, failed = numbers.id_of, numbers.id_of(shown.rejected), numbers.id_of(shown.failed)
    return Report(
        at=at,
        robot=robot,
        boot_id=shown.boot,
        state=STATES[shown.state],
        accepted=id(shown.accepted),
        done=None if answered else id(shown.done),
        rejected=rejected,
        refusal=None if rejected is None else shown.reason or UNNAMED,
        failed=failed,
        failure=None if failed is None else shown.failure or UNNAMED,
        answered=id(question.number) if answered and question is not None else None,
        answer=question.answer if answered and question is not None else None,
        facts=shown.facts,
        receipt=None if shown.accepted is None else Receipt(PLC_EPOCH, shown.accepted, shown.done or None),
    )


class ProgramWatch:
    """Check of a PLC's heartbeat: one whose program stands still goes on answering, with old values."""

    def __init__(self, patience_s: float) -> None:
        self._patience_s = patience_s
        self._changed: tuple[int | float, float] | None = None

    def begin(self) -> None:
        """Forget the number seen, for a new connection."""
        self._changed = None

    def see(self, at: float, place: str, number: int | float) -> None:
        """Note the number; raises UnreadableValue if it has not changed for too long."""
        if self._changed is None or self._changed[0] != number:
            self._changed = (number, at)
        elif at - self._changed[1] > self._patience_s:
            what = f"{place} is {number} for {self._patience_s:g} s"
            raise UnreadableValue(f"the program of the PLC stands still: {what}")
