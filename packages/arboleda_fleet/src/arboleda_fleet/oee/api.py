"""The OEE of a plant as the web server sees it."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Protocol

from arboleda.oee.figures import Oee

DAY_S = 86_400.0


@dataclass(frozen=True, kw_only=True)
class OeeQuery:
    """Query for OEE: a cell, "" for all, and a span in Unix times; without a span, the last day."""

    cell: str = ""
    since_s: float | None = None
    until_s: float | None = None

    def span(self, now_s: float) -> tuple[float, float]:
        """The begin and the end of the span, neither later than now."""
        until_s = now_s if self.until_s is None else min(self.until_s, now_s)
        return (until_s - DAY_S if self.since_s is None else self.since_s), until_s


class OeeApi(Protocol):
    """OEE of one plant."""

    @abstractmethod
    def oee(self, query: OeeQuery) -> list[Oee]:
        """The OEE of its cells, in the order of the plant file; waits for the disk."""
