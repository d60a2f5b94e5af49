"""The tables of the times in which a plant ran, and in which its cells did no work."""

from __future__ import annotations

from collections.abc import Sequence

from .rows import Rows, Statement


class TimeTable:
    """The runs of a plant, and the downtimes of its cells; times are Unix times."""

    def __init__(self, rows: Rows) -> None:
        self._rows = rows
        self._older: int | None = None  # the last downtime of an earlier start; None before `began`

    def began(self, unix_s: float) -> None:
        """Commit that the plant runs, and forget what was over before the oldest task that is kept."""
        ((self._older,),) = self._rows.read("SELECT coalesce(max(number), 0) FROM down")
        oldest = "(SELECT min(accepted_s) FROM task)"
        last = "SELECT seen_s FROM run WHERE number = (SELECT max(number) FROM run) AND seen_s > down.since_s"
        for statement in (
            # of a leader of an older version, on a database that a standby of this one has brought up
            ("UPDATE task SET ran_s = 0 WHERE ended_s IS NOT NULL AND ran_s IS NULL", ()),
            (f"UPDATE down SET until_s = coalesce(({last}), since_s) WHERE until_s IS NULL", ()),
            (f"DELETE FROM down WHERE until_s < {oldest}", ()),
            (f"DELETE FROM run WHERE seen_s < {oldest}", ()),
            ("INSERT INTO run (since_s, seen_s, ended) VALUES (?, ?, 0)", (unix_s, unix_s)),
        ):
            self._rows.write(statement, durable=False)

    def note_run(self, unix_s: float, *, ended: bool = False) -> None:
        """Commit that the plant still runs, or that it was ended."""
        last = "number = (SELECT max(number) FROM run)"
        update = f"UPDATE run SET seen_s = ?, ended = ? WHERE {last}"
        self._rows.write((update, (unix_s, int(ended))), durable=False)

    def moved(self, by_s: float) -> Sequence[Statement]:
        """The statements that move the times of this run, and of downtimes in it."""
        if self._older is None:
            return ()
        run = "number = (SELECT max(number) FROM run)"
        down = "UPDATE down SET since_s = since_s + ?, until_s = until_s + ?"
        values = (by_s, by_s)
        return (
            (f"{down} WHERE number > ?", (*values, self._older)),
            (f"UPDATE run SET since_s = since_s + ?, seen_s = seen_s + ? WHERE {run}", values),
        )

    def stands(self, cell: str, state: str | None, unix_s: float) -> None:
        """Commit that a cell does no work from now on, in this state; None: it works again."""
        over = "UPDATE down SET until_s = ? WHERE cell = ? AND until_s IS NULL"
        self._rows.write((over, (unix_s, cell)), durable=False)
        if state is not None:
            begun = "INSERT INTO down (cell, state, since_s) VALUES (?, ?, ?)"
            self._rows.write((begun, (cell, state, unix_s)), durable=False)
