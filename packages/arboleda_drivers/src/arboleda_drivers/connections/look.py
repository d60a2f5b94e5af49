"""Progress of a work, as one look at its device shows it."""

from __future__ import annotations

from dataclasses import dataclass


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
