"""What is asked of the row that says who leads a plant, in SQL."""

from __future__ import annotations

LAST_SEEN = "SELECT epoch, seen FROM leader"
# of a leader who has said nothing since: where he has, this changes nothing
END_LEASE = "UPDATE leader SET seen = NULL WHERE epoch = %s AND seen = %s RETURNING epoch"


def lately(column: str, within: str = "%s") -> str:
    """Whether that was said within so many seconds. A time far ahead is one from before the server's clock
    was set back, and is as old as one far behind."""
    return f"coalesce(abs(extract(epoch FROM clock_timestamp() - {column})) < {within}, FALSE)"
