"""Rate of a robot's reports, as screens show it."""

from __future__ import annotations

RATE_S = 2.0  # it is counted over at least this long


class ReportRate:
    """Counts reports: `hz` is None until it was counted, `since` when that was done last."""

    def __init__(self) -> None:
        self.hz: float | None = None
        self.since = 0.0
        self._reports = 0

    def count(self, at: float, reports: int, *, online: bool) -> None:
        """Take the number of the last report, where the rate is due to be counted."""
        if reports == 1 or not online:
            self.hz = None
        elif at - self.since < RATE_S:
            return
        else:
            self.hz = (reports - self._reports) / (at - self.since)
        self.since, self._reports = at, reports
