"""The tables of the times in which a plant ran, and in which its cells did no work."""

from __future__ import annotations

from .rows import Rows


class TimeTable:
    """The runs of a plant, and the downtimes of its cells; times are Unix times."""

    def __init__(self, rows: Rows) -> None:
        self._rows = rows

    def began(self, unix_s: float, before_unix_s: float) -> None:
        """Commit that the plant runs, and forget downtimes that ended long ago."""
        last = "SELECT seen_s FROM run WHERE number = (SELECT max(number) FROM run) AND seen_s > down.since_s"
        for statement in (
            (f"UPDATE down SET until_s = coalesce(({last}), since_s) WHERE until_s IS NULL", ()),
            ("DELETE FROM down WHERE until_s < ?", (before_unix_s,)),
            ("DELETE FROM run WHERE seen_s < ?", (before_unix_s,)),
            ("INSERT INTO run (since_s, seen_s, ended) VALUES (?, ?, 0)", (unix_s, unix_s)),
        ):
            self._rows.write(statement, durable=False)

    def note_run(self, unix_s: float, *, ended: bool = False) -> None:
        """Commit that the plant still runs, or that it was ended."""
        last = "number = (SELECT max(number) FROM run)"
        update = f"UPDATE run SET seen_s = ?, ended = ? WHERE {last}"
        self._rows.write((update, (unix_s, int(ended))), durable=False)

    def stands(self, cell: str, state: str | None, unix_s: float) -> None:
        """Commit that a cell does no work from now on, in this state; None: it works again."""
        over = "UPDATE down SET until_s = ? WHERE cell = ? AND until_s IS NULL"
        self._rows.write((over, (unix_s, cell)), durable=False)
        if state is not None:
            begun = "INSERT INTO down (cell, state, since_s) VALUES (?, ?, ?)"
            self._rows.write((begun, (cell, state, unix_s)), durable=False)
