"""Invariants of OEE: each cell's figures are what was seen of its work, span by span."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise
from operator import attrgetter

from arboleda.model.messages import ENDED, TaskState
from arboleda.oee.figures import ENOUGH, LATE_S, TIMES, Oee, PastTask, PastTimes, PlantRun, Shortest, oee

from ..recorded.tasks import KnownTask
from .invariant import Look, Trigger, invariant

LAST = 50  # tasks of a cell; more take long
EXACT = 1e-6
ITEMS = (TaskState.DONE, TaskState.FAILED)


@invariant(Trigger.END)
def oee_is_as_seen(look: Look) -> Iterator[str]:
    """The figures of a cell are what its tasks, its states and the starts of the plant add up to: in all of
    the time and in a part of it, while the plant runs, once it was ended, and long after it was killed.
    """
    record, now = look.record, look.record.step.at
    for cell in record.cells:
        works = [_work(task) for task in record.tasks.of_cell(cell)[-LAST:]]
        for ended, until_s in ((False, now), (True, now + 1.0), (False, now + LATE_S + 1.0)):
            runs = record.times.runs(now, ended=ended)
            begin = runs[0].since_s
            kept = PastTimes(works=works, runs=runs, downs=record.times.downs, shortest=_shortest(works))
            for since_s in (begin - 1.0, begin + (now - begin) / 3.0):
                yield from _unlike(oee(cell, kept, since_s, until_s), _Interval(kept, cell, until_s))


def _work(task: KnownTask) -> PastTask:
    return PastTask(
        cell=task.cell,
        order=task.message.text.partition(" #")[0],
        state=task.state.value,
        accepted_s=task.accepted,
        started_s=task.began,
        ended_s=task.since if task.state in ENDED else None,
    )


def _shortest(works: list[PastTask]) -> dict[tuple[str, str], Shortest]:
    took: dict[tuple[str, str], list[float]] = {}
    for work in works:
        if work.state == TaskState.DONE and work.started_s is not None and work.ended_s is not None:
            took.setdefault((work.cell, work.order), []).append(work.ended_s - work.started_s)
    return {key: Shortest(times=len(times), seconds=min(times)) for key, times in took.items()}


class _Interval:
    """Sums of what was seen of a cell: its state at an instant, and for how many seconds a state lasted."""

    def __init__(self, kept: PastTimes, cell: str, until_s: float) -> None:
        self._runs, self._until_s = kept.runs, until_s
        self._downs = [each for each in kept.downs if each.cell == cell]
        self._works = kept.works
        self._best = {key: short.seconds for key, short in kept.shortest.items() if short.times >= TIMES}
        spans = [(each.since_s, each.until_s) for each in self._downs]
        spans += [(each.since_s, each.seen_s) for each in self._runs]
        spans += [(each.accepted_s, each.ended_s) for each in self._works]
        edges = {edge for span in spans for edge in span if edge is not None}
        edges |= {work.started_s for work in self._works if work.started_s is not None}
        self._edges = sorted(edges | {until_s})

    @property
    def since_s(self) -> float:
        return self._runs[0].since_s

    def items(self, since_s: float) -> list[PastTask]:
        """The tasks that began after that time and were done or failed."""
        over = [each for each in self._works if each.state in ITEMS and each.started_s is not None]
        return [each for each in over if since_s <= (each.ended_s or 0.0) < self._until_s]

    def best_s(self, work: PastTask) -> float | None:
        return self._best.get((work.cell, work.order))

    def took_s(self, work: PastTask) -> float:
        pieces = self.pieces(work.started_s or 0.0, work.ended_s or 0.0)
        return sum([seconds for at, seconds in pieces if self.is_up(at)])

    def pieces(self, since_s: float, until_s: float) -> list[tuple[float, float]]:
        """The middle and the length of each piece of a time in which nothing changed, s."""
        edges = [since_s, *[edge for edge in self._edges if since_s < edge < until_s], until_s]
        return [((a + b) / 2, b - a) for a, b in pairwise(edges) if b > a]

    def is_up(self, at: float) -> bool:
        """True if the plant ran then, and the cell did not stand."""
        downs = [each for each in self._downs if each.since_s < at]
        stood = [each for each in downs if each.until_s is None or at < each.until_s]
        return not stood and self._run_at(at)[1]

    def is_planned(self, at: float) -> bool:
        """True if a task waited or was at work then, and the plant was not ended."""
        accepted = [each for each in self._works if each.accepted_s < at]
        wanted = [each for each in accepted if each.ended_s is None or at < each.ended_s]
        run, runs = self._run_at(at)
        return bool(wanted) and (runs or not run.ended)

    def is_at_work(self, at: float) -> bool:
        begun = [each for each in self._works if each.started_s is not None and each.started_s < at]
        last = [each for each in begun if each.ended_s is None or at < each.ended_s]
        return bool(last) and self.is_up(at)

    def _run_at(self, at: float) -> tuple[PlantRun, bool]:
        """The last start of the plant before that time, and whether it still ran."""
        run = max([each for each in self._runs if each.since_s < at], key=attrgetter("since_s"))
        lasts = run is self._runs[-1] and not run.ended and self._until_s - run.seen_s <= LATE_S
        return run, lasts or at < run.seen_s


def _unlike(oee: Oee, interval: _Interval) -> Iterator[str]:
    begin, until_s = max(oee.since_s, interval.since_s), oee.until_s
    items = interval.items(begin)
    states = Counter(work.state for work in items)
    timed = [(best_s, work) for work in items if (best_s := interval.best_s(work)) is not None]
    took_s = sum(interval.took_s(work) for _, work in timed)
    compared = items and len(timed) >= ENOUGH * len(items) and took_s > 0
    planned = [(at, seconds) for at, seconds in interval.pieces(begin, until_s) if interval.is_planned(at)]
    planned_s = sum([seconds for _, seconds in planned])
    worked_s = sum([seconds for at, seconds in planned if interval.is_at_work(at)])
    availability = worked_s / planned_s if planned_s else None
    performance = sum(best_s for best_s, _ in timed) / took_s if compared else None
    quality = states[TaskState.DONE] / len(items) if items else None
    known = availability is not None and performance is not None and quality is not None
    expected = {
        "since_s": begin,
        "planned_s": planned_s,
        "worked_s": worked_s,
        "done": states[TaskState.DONE],
        "failed": states[TaskState.FAILED],
        "timed": len(timed),
        "availability": availability,
        "performance": performance,
        "quality": quality,
        "oee": (availability or 0.0) * (performance or 0.0) * (quality or 0.0) if known else None,
    }
    for key, value in expected.items():
        shown = getattr(oee, key)
        if (shown is None) is not (value is None) or abs((shown or 0.0) - (value or 0.0)) > EXACT:
            yield f"{oee.cell}: {key} is told as {shown}, it was {value}"
    if (oee.missing is None) is not known:
        yield f"{oee.cell}: {oee.missing!r} is told to be missing of {expected}"


OEE = (oee_is_as_seen,)
