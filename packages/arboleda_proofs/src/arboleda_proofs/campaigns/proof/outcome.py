"""Outcomes of a task that something befell, as plain data."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from enum import Enum
from typing import Any


class End(str, Enum):
    """The end of a task; the value is its word on every screen and in every file."""

    DONE = "done"  # as if nothing had happened
    RECOVERED = "recovered"  # done, by other commands than without the fault
    HELD = "held"  # its cell waits for an operator
    FAILED = "failed"
    CANCELLED = "cancelled"
    REFUSED = "refused"
    LOST = "lost"  # the request never reached a plant that runs
    UNFINISHED = "unfinished"  # still at work when far more time had passed than it takes


MOST_ACTS = 6  # of a person, until a cell works again
IS_DONE = (End.DONE, End.RECOVERED)


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Outcome of one run. `cause`: of a failure or a hold, a word. `alone`: its cell got ready again without
    a person; `acts`: so many of those that the plant advises got it ready, None: it never was; `did`: which,
    in the plant's words. `untrue`: what is not so although the task is done. `broken`: the invariant and the
    sentence.
    """

    end: End
    cause: str = ""
    alone: bool = True
    acts: int | None = 0
    did: tuple[str, ...] = ()
    untrue: tuple[str, ...] = ()
    broken: tuple[str, str] | None = None

    @property
    def words(self) -> str:
        """The end, with its cause."""
        return f"{self.end.value}: {self.cause}" if self.cause else self.end.value

    @property
    def takes_too_much(self) -> bool:
        """True if what the plant advises does not get the cell ready, or not in as few acts as it should."""
        return self.broken is None and (self.acts is None or self.acts > MOST_ACTS)

    @property
    def goes_unnoticed(self) -> bool:
        """True if the task is called done and something is not as it is to be then."""
        return self.end in IS_DONE and bool(self.untrue)


@dataclass(frozen=True, kw_only=True)
class Run:
    """One run: its outcome, its trace as one hash, and its times in s: when the fault was mended at the
    latest, when the attendant came, and when it was over; `joined_at`: from when on it was as the calm one.
    """

    outcome: Outcome
    digest: str
    mended_at: float
    attended_at: float
    seconds: float
    joined_at: float | None = None


def with_acts(outcome: Outcome, acts: tuple[str, ...] | None) -> Outcome:
    """An outcome with the acts that got the cell ready; None: it never was."""
    return replace(outcome, acts=None if acts is None else len(acts), did=acts or ())


def plain(outcome: Outcome) -> dict[str, Any]:
    """An outcome for JSON."""
    return {**asdict(outcome), "end": outcome.end.value}


def outcome_from(data: dict[str, Any]) -> Outcome:
    """The outcome that `plain` wrote."""
    broken = data["broken"]
    return Outcome(
        end=End(data["end"]),
        cause=data["cause"],
        alone=data["alone"],
        acts=data["acts"],
        did=tuple(data["did"]),
        untrue=tuple(data["untrue"]),
        broken=None if broken is None else (broken[0], broken[1]),
    )
