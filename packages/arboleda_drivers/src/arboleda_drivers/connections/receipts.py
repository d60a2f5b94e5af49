"""Progress of a work as looks at its device show it, ends of commands as reports tell them, and when."""

from __future__ import annotations

import math
from dataclasses import dataclass

from arboleda.drivers import Report, Value


@dataclass(frozen=True, kw_only=True)
class Look:
    """Progress of a work: accepted, or over; `lines` are the next ones to its controller."""

    accepted: bool = False
    done: bool = False
    refused: str = ""
    failed: str = ""
    lines: tuple[str, ...] = ()

    @property
    def is_end(self) -> bool:
        return self.done or bool(self.refused or self.failed)


NOTHING = Look()


class Receipts:
    """Ends of commands by the fields of a report, which each report repeats; `news`: one is due at once."""

    def __init__(self) -> None:
        self.news = False
        self._fields: dict[str, Value] = {}
        self._reported_at = -math.inf

    def tell(self, **fields: str) -> None:
        """Note the ends of commands; nothing is told of a command without an id."""
        self._fields |= {name: value for name, value in fields.items() if value}
        self.news = True

    def reject(self, id: str, word: str) -> None:
        if id:
            self.tell(rejected=id, refusal=word)

    def answer(self, id: str, value: Value) -> None:
        """Note the answer to a query."""
        self._fields |= {"answered": id, "answer": value}
        self.news = True

    def take(self, id: str, look: Look) -> None:
        """Note what a look at the work of a command shows."""
        if look.accepted:
            self.tell(accepted=id)
        if look.done:
            self.tell(done=id)
        elif look.refused:
            self.reject(id, look.refused)
        elif look.failed:
            self.tell(failed=id, failure=look.failed)

    def forget(self) -> None:
        """The device began anew, and knows of no command."""
        self._fields, self.news = {}, True

    def is_due(self, now: float, every_s: float) -> bool:
        """True where a report is to leave now, as `every_s` goes by at most between two."""
        return self.news or now >= self._reported_at + every_s

    def on(self, now: float, report: Report) -> Report:
        """The report that leaves now, with the ends of commands."""
        self.news, self._reported_at = False, now
        return report.again(now, **self._fields)
