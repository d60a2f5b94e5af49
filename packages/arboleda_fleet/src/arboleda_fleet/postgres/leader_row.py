"""SQL conditions on the row that names the leader of a plant."""

from __future__ import annotations

LAST_SEEN = "SELECT epoch, seen FROM leader"
# only if the leader is silent since then; otherwise this changes nothing
END_LEASE = "UPDATE leader SET seen = NULL WHERE epoch = %s AND seen = %s RETURNING epoch"


def lately(column: str, within: str = "%s") -> str:
    """SQL that is true if the time in `column` is less than `within` seconds away from the server's clock.

    A time far ahead was written before the clock was set back, and counts as old.
    """
    return f"coalesce(abs(extract(epoch FROM clock_timestamp() - {column})) < {within}, FALSE)"
