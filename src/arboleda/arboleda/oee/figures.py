"""Share of its planned time in which a cell did good work: OEE by the formula of ISO 22400-2. Pure.

OEE = availability x performance x quality; docs/how-to/oee.md defines the three factors.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.model.messages import TaskState
from arboleda.model.sentence import Phrase, Sentence

Span = tuple[float, float]  # from, until; Unix times
SEEN_S = 60.0  # period in which a running plant notes that it runs
LATE_S = 3 * SEEN_S  # a plant without a note for so long does not run
TIMES = 3  # an order has a shortest time after so many successes at the first attempt
ENOUGH = 0.5  # share of the tasks that must have a shortest time

NEVER_RAN = Phrase("oee.never_ran", "nothing was kept of that time")
NO_PLAN = Phrase("oee.no_plan", "no task waited or was at work")
NOTHING_ENDED = Phrase("oee.nothing_ended", "no task was done or failed")
FEW_TIMES = Phrase(
    "oee.few_times",
    "{known} of {all} tasks can be compared: the same task has to be done {times} times at the first attempt",
)


@dataclass(frozen=True, kw_only=True)
class PastTask:
    """Task from the history; an open one has no end."""

    cell: str
    order: str
    state: str
    accepted_s: float
    started_s: float | None
    ended_s: float | None


@dataclass(frozen=True, kw_only=True)
class PlantRun:
    """Run of the plant: its start, the last time at which it ran for certain, and whether it was ended."""

    since_s: float
    seen_s: float
    ended: bool


@dataclass(frozen=True, kw_only=True)
class Downtime:
    """Time in which a cell stood in a state without work; without an end while it lasts."""

    cell: str
    since_s: float
    until_s: float | None


@dataclass(frozen=True, kw_only=True)
class Shortest:
    """Number of times that an order was done at the first attempt, and the shortest time, s."""

    times: int
    seconds: float


@dataclass(frozen=True, kw_only=True)
class PastTimes:
    """Rows of a plant's memory for a span of time; `shortest` is by cell and order, over all time."""

    works: Sequence[PastTask]
    runs: Sequence[PlantRun]
    downs: Sequence[Downtime]
    shortest: Mapping[tuple[str, str], Shortest]


@dataclass(frozen=True, kw_only=True)
class Oee:
    """OEE figures of one cell, shares from 0 to 1; None if they are unknown, for the reason `missing`.

    `since_s` is the begin of the recorded time. `timed` counts the tasks whose shortest time is known.
    """

    cell: str
    since_s: float
    until_s: float
    planned_s: float
    worked_s: float
    done: int
    failed: int
    timed: int
    availability: float | None
    performance: float | None
    quality: float | None
    oee: float | None
    missing: Sentence | None

    def data(self) -> dict[str, Any]:
        """The figures as plain data for JSON."""
        return {**vars(self), "missing": None if self.missing is None else str(self.missing)}


def oee(cell: str, times: PastTimes, since_s: float, until_s: float) -> Oee:
    """The OEE of a cell from `since_s` to `until_s`, which is not later than now."""
    first_s = min((run.since_s for run in times.runs), default=until_s)
    begin = min(max(since_s, first_s), until_s)
    window = [(begin, until_s)]
    ran, broke = _runs(times.runs, until_s)
    works = [work for work in times.works if work.cell == cell]
    down = [(each.since_s, _end(each.until_s, until_s)) for each in times.downs if each.cell == cell]
    work_spans = joined((work.accepted_s, _end(work.ended_s, until_s)) for work in works)
    planned = common(common(work_spans, joined([*ran, *broke])), window)
    working = without(ran, joined(down))
    at_work = joined(_at_work(work, until_s) for work in works if work.started_s is not None)
    worked_s = length(common(common(at_work, working), planned))
    produced = [work for work in works if _produced(work, begin, until_s)]
    done = sum(work.state == TaskState.DONE for work in produced)
    timed = [
        (short.seconds, length(common([_at_work(work, until_s)], working)))
        for work in produced
        if (short := times.shortest.get((cell, work.order))) is not None and short.times >= TIMES
    ]
    planned_s = length(planned)
    needed_s, took_s = sum(best for best, _ in timed), sum(took for _, took in timed)
    availability = worked_s / planned_s if planned_s > 0 else None
    quality = done / len(produced) if produced else None
    compared = bool(produced) and len(timed) >= ENOUGH * len(produced) and took_s > 0
    performance = needed_s / took_s if compared else None
    whole = None
    if availability is not None and performance is not None and quality is not None:
        whole = availability * performance * quality
    return Oee(
        cell=cell,
        since_s=begin,
        until_s=until_s,
        planned_s=planned_s,
        worked_s=worked_s,
        done=done,
        failed=len(produced) - done,
        timed=len(timed),
        availability=availability,
        performance=performance,
        quality=quality,
        oee=whole,
        missing=_missing(begin, until_s, planned_s, len(produced), len(timed)) if whole is None else None,
    )


def _missing(begin: float, until_s: float, planned_s: float, produced: int, timed: int) -> Sentence:
    if begin >= until_s:
        return NEVER_RAN()
    if planned_s <= 0:
        return NO_PLAN()
    if not produced:
        return NOTHING_ENDED()
    return FEW_TIMES(known=timed, all=produced, times=TIMES)


def _runs(runs: Sequence[PlantRun], now_s: float) -> tuple[list[Span], list[Span]]:
    """The spans in which the plant ran, and those from a crash until the next start or now."""
    ran: list[Span] = []
    broke: list[Span] = []
    in_order = sorted(runs, key=lambda run: run.since_s)
    for number, run in enumerate(in_order, start=1):
        following = in_order[number] if number < len(in_order) else None
        next_s = following.since_s if following is not None else now_s
        lasts = following is None and not run.ended and now_s - run.seen_s <= LATE_S
        seen_s = min(next_s if lasts else run.seen_s, next_s)
        ran.append((run.since_s, seen_s))
        if not run.ended:
            broke.append((seen_s, next_s))
    return joined(ran), joined(broke)


def _produced(work: PastTask, since_s: float, until_s: float) -> bool:
    """True if a task was begun, and was done or failed in that time."""
    over = work.started_s is not None and work.state in (TaskState.DONE, TaskState.FAILED)
    return over and work.ended_s is not None and since_s <= work.ended_s < until_s


def _at_work(work: PastTask, now_s: float) -> Span:
    return (now_s if work.started_s is None else work.started_s, _end(work.ended_s, now_s))


def _end(end_s: float | None, now_s: float) -> float:
    return now_s if end_s is None else end_s


def joined(spans: Iterable[Span]) -> list[Span]:
    """The spans in order, with overlaps merged; a span that ends before it begins is dropped."""
    merged: list[Span] = []
    for since, until in sorted(span for span in spans if span[1] > span[0]):
        if merged and since <= merged[-1][1]:
            merged[-1] = (merged[-1][0], max(merged[-1][1], until))
        else:
            merged.append((since, until))
    return merged


def common(one: Iterable[Span], other: Iterable[Span]) -> list[Span]:
    """The times that are in both; each list is `joined`."""
    ours, theirs, shared = list(one), list(other), []
    here = there = 0
    while here < len(ours) and there < len(theirs):
        (our_since, our_until), (their_since, their_until) = ours[here], theirs[there]
        since, until = max(our_since, their_since), min(our_until, their_until)
        if until > since:
            shared.append((since, until))
        here, there = (here + 1, there) if our_until <= their_until else (here, there + 1)
    return shared


def without(spans: Iterable[Span], gaps: Sequence[Span]) -> list[Span]:
    """The times that are in `spans` and not in `gaps`; each list is `joined`."""
    edges = [float("-inf"), *(edge for gap in gaps for edge in gap), float("inf")]
    return common(spans, list(zip(edges[::2], edges[1::2], strict=True)))


def length(spans: Iterable[Span]) -> float:
    """The total length, s."""
    return sum(until - since for since, until in spans)
