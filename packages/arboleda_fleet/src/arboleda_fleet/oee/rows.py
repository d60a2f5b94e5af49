"""OEE of a plant's cells from the rows of its memory, and the OeeApi of the plant in this process."""

from __future__ import annotations

import time
from collections.abc import Sequence

from arboleda.extension import ArboledaError
from arboleda.oee.figures import Downtime, Oee, PastTask, PastTimes, PlantRun, Shortest, oee
from arboleda.store.task_rows import Database, History

from .api import OeeApi, OeeQuery

NOTHING = PastTimes(works=[], runs=[], downs=[], shortest={})


class OeeDesk(OeeApi):
    """For threads of a server, which wait for the disk."""

    def __init__(self, history: History, cells: Sequence[str]) -> None:
        self._history = history
        self._cells = cells

    def oee(self, query: OeeQuery) -> list[Oee]:
        return figures(self._history, query, time.time(), self._cells)


def figures(history: History, query: OeeQuery, now_s: float, cells: Sequence[str] | None = None) -> list[Oee]:
    """The OEE of these cells, or of all that had a task, up to `now_s` at the latest.

    Raises ArboledaError where the memory cannot be read.
    """
    since_s, until_s = query.span(now_s)
    found = history.read(lambda db: _kept(db, since_s, until_s)) or NOTHING
    if cells is None:
        cells = sorted({work.cell for work in found.works})
    wanted = [cell for cell in cells if query.cell in ("", cell)]
    return [oee(cell, found, since_s, until_s) for cell in wanted]


def _kept(db: Database, since_s: float, until_s: float) -> PastTimes:
    """The tasks, runs and downtimes that the memory has of this time, in s."""
    begun = "started_s IS NOT NULL AND ended_s > started_s"
    works = db.execute(
        "SELECT cell, text, state, accepted_s, started_s, ended_s FROM task WHERE ended_s IS NULL"
        " UNION ALL SELECT cell, text, state, accepted_s, started_s, ended_s FROM task WHERE ended_s >= ?",
        (since_s,),
    )
    runs = db.execute("SELECT since_s, seen_s, ended FROM run")
    downs = db.execute(
        "SELECT cell, since_s, until_s FROM down WHERE since_s < ? AND (until_s IS NULL OR until_s > ?)",
        (until_s, since_s),
    )
    shortest = db.execute(
        "SELECT cell, text, count(*), min(ended_s - started_s) FROM task"
        f" WHERE state = 'done' AND attempts <= 1 AND {begun} GROUP BY cell, text"
    )
    try:
        return PastTimes(
            works=[
                PastTask(
                    cell=cell, order=text, state=state, accepted_s=0.0 + at, started_s=begin, ended_s=end
                )
                for cell, text, state, at, begin, end in works
            ],
            runs=[
                PlantRun(since_s=0.0 + since, seen_s=0.0 + end_s, ended=bool(end))
                for since, end_s, end in runs
            ],
            downs=[Downtime(cell=cell, since_s=0.0 + since, until_s=until) for cell, since, until in downs],
            shortest={
                (cell, text): Shortest(times=times, seconds=best) for cell, text, times, best in shortest
            },
        )
    except TypeError as error:
        what = "of times what is of another type than it wrote"
        raise ArboledaError(f"The plant's memory says {what}: put a backup in its place.") from error
