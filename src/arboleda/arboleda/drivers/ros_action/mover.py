"""What the goals of an action move, as the machine of all such drivers asks for it."""

from __future__ import annotations

from typing import Any, Protocol

from arboleda.model.commands import Command

from .events import GoalResult, Measurement, Status


class NoGoal(Exception):
    """A command is none that the action has a word for."""


class Mover(Protocol):
    """Where it is follows only from what is measured: no result of a server is believed by itself."""

    name: str
    replaces: bool  # whether a new command takes the place of one that is open, rather than being refused

    def see(self, now: float, seen: Measurement) -> bool:
        """Take what was measured; whether it is news of this device."""

    def missing(self, now: float) -> str:
        """Why nothing is known of where it is; "" where that is known."""

    def goals(self, command: Command) -> tuple[Any, ...]:
        """What the server is to be sent, one after the other; NoGoal where the action has no word for it."""

    def heard_since(self, at: float) -> bool:
        """Whether anything was measured after that."""

    def is_at(self, goal: Any) -> bool:
        """Whether it stands where a goal leads."""

    def rests(self, now: float, since: float = 0.0) -> bool:
        """Whether it has been at rest, for as long as that takes to be seen, after `since`."""

    def failure(self, end: GoalResult, goal: Any) -> str:
        """Why a goal failed by the server's own result, in a word; "" where it did not."""

    def objection(self, goal: Any) -> str:
        """What is wrong where it has come to rest after a result that says that all is well; "" for nothing.

        What work leads to needs none: the plant compares the position and the facts that are reported.
        """

    def settle(self, goal: Any) -> None:
        """A goal has ended with the device at rest; None: it has ended, and nobody knows where."""

    def shows(self, *, busy: bool) -> dict[str, Any]:
        """The fields of a report that say where it is; `busy`: a goal is open."""


def failure(end: GoalResult, errors: dict[int, str]) -> str:
    """The word for an end that is no success; what the server adds follows it."""
    if end.status is Status.SUCCEEDED and end.error == 0:
        return ""
    if end.status is Status.CANCELED:
        word = "cancelled_by_another_client"
    else:
        word = errors.get(end.error, "aborted" if end.error == 0 else f"error {end.error}")
    return f"{word} {end.text}".strip()
