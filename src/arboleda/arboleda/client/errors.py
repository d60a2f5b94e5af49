"""Errors of the client: each the sentence of the plant, or of the way to it, with its data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from arboleda.model.errors import ArboledaError, QueueFull, TextError
from arboleda.model.outside import plain
from arboleda.model.packages import PackageMissing

if TYPE_CHECKING:
    from .answers.tasks import Task

LONGEST = 300  # characters of what a plant says that are shown


class PlantError(ArboledaError):
    """Error of the client, one sentence for a person."""


class NoAnswer(PlantError):
    """Nobody answered; `may_have_heard` if what was asked may have been done all the same. `clause` is the
    reason as the end of a sentence that begins with the plant's name."""

    def __init__(self, sentence: str, *, may_have_heard: bool, clause: str = " did not answer.") -> None:
        super().__init__(sentence)
        self.may_have_heard = may_have_heard
        self.clause = clause


class StillRunning(PlantError):
    """A task had not ended when the time to wait was over; `task` is its last known state."""

    def __init__(self, task: Task) -> None:
        super().__init__(f"#{task.id} has not ended yet, it is {task.state}")
        self.task = task


class LibraryMissing(PlantError):
    """A library is not installed; the sentence says how to install it."""


class MethodMissing(PlantError, PackageMissing, AttributeError):
    """A package adds the method, and is not installed here; the sentence says how to install it."""


class Refusal(PlantError):
    """The plant refuses; `key` and `values` say why as data, where it has such; `data` is all of it."""

    def __init__(self, status: int, data: Mapping[str, Any], *, retry_after_s: float | None = None) -> None:
        super().__init__(plain(str(data.get("sentence", "")), LONGEST))
        self.status = status
        self.data = dict(data)
        self.key: str | None = data.get("key")
        self.values: Mapping[str, Any] = data.get("values") or {}
        self.retry_after_s = retry_after_s


class Unauthorized(Refusal):
    """It wants a token, or does not know the one that was shown."""


class Forbidden(Refusal):
    """The role of the token is not enough."""


class NotFound(Refusal):
    """There is no such task, act or file."""


class Conflict(Refusal):
    """The plant does not do this now."""


class WrongRequest(Refusal, TextError):
    """Error: a request names something that the plant does not have, or that cannot be."""


class Later(Refusal, QueueFull):
    """Not now: a queue or a limit is full; `retry_after_s` says when to try again, where that is known."""


class OtherPlant(Refusal):
    """Another plant answers at the address."""


BY_STATUS: dict[int, type[Refusal]] = {
    401: Unauthorized,
    403: Forbidden,
    404: NotFound,
    409: Conflict,
    421: OtherPlant,
    422: WrongRequest,
    429: Later,
}


def refusal(status: int, data: Mapping[str, Any], retry_after: str | None) -> Refusal:
    """The error that an answer stands for; `retry_after` is its header."""
    later = float(retry_after) if retry_after and retry_after.isdigit() else None
    usual = Refusal if later is None else Later
    return BY_STATUS.get(status, usual)(status, data, retry_after_s=later)
