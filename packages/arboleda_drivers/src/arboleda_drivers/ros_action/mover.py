"""Interface between the machine of all drivers of ROS actions and the device that the goals move."""

from __future__ import annotations

from typing import Any, Protocol

from arboleda.drivers import Command

from .events import GoalResult, Measurement, Status


class NoGoal(Exception):
    """Error: the action cannot express a command."""


class Mover(Protocol):
    """Device that goals move. Its position follows from measurements only, never from a server's result."""

    name: str
    replaces: bool  # True: a new command replaces an open one; False: it is refused

    def see(self, now: float, measurement: Measurement) -> bool:
        """Take a measurement; True if it is news of this device."""

    def missing(self, now: float) -> str:
        """The reason why the device's position is unknown; "" if it is known."""

    def goals(self, command: Command) -> tuple[Any, ...]:
        """The goals to send for a command, in order; raises NoGoal if the action cannot express it."""

    def has_measured_since(self, at: float) -> bool:
        """True if a measurement came after that time."""

    def is_at(self, goal: Any) -> bool:
        """True if the device stands where `goal` leads."""

    def rests(self, now: float, since: float = 0.0) -> bool:
        """True if the device has been at rest after `since`, for long enough to be sure."""

    def failure(self, end: GoalResult, goal: Any) -> str:
        """The word for a failure by the server's own result; "" for a success."""

    def objection(self, goal: Any) -> str:
        """The fault found at rest after a result that reports success, in a word; "" for none.

        Work needs none: the plant compares the reported position and facts.
        """

    def settle(self, goal: Any) -> None:
        """Note the end of a goal with the device at rest; None: it has ended at an unknown position."""

    def shows(self, *, busy: bool) -> dict[str, Any]:
        """The fields of a report that hold the position; `busy`: a goal is open."""


def failure(end: GoalResult, errors: dict[int, str]) -> str:
    """The word for an end without success, followed by the server's own text."""
    if end.status is Status.SUCCEEDED and end.error == 0:
        return ""
    if end.status is Status.CANCELED:
        word = "cancelled_by_another_client"
    else:
        word = errors.get(end.error, "aborted" if end.error == 0 else f"error {end.error}")
    return f"{word} {end.text}".strip()
