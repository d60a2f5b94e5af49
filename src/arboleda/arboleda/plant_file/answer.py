"""Answers with what is wrong with a plant, and what would mend it, as data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .findings import Finding, checked
from .mend import Mend
from .offers import Offer, offers

Mending = Callable[
    [Path, tuple[Finding, ...]], Mend | None
]  # a plant file and what is wrong with it -> a mend


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Answer: findings, and the mend for them; None where nothing that was tried makes it better.

    `offers`: what the plant file could state, and does not.
    """

    findings: tuple[Finding, ...]
    mend: Mend | None = None
    offers: tuple[Offer, ...] = ()

    @property
    def plain(self) -> dict[str, Any]:
        """The answer for JSON."""
        return {
            "findings": [each.plain for each in self.findings],
            "mend": None if self.mend is None else self.mend.plain,
            "offers": [each.plain for each in self.offers],
        }


def check_answer(file: Path, *, mending: Mending | None = None, apart: bool = True) -> Answer:
    """The findings of `arboleda check`, with a mend if `mending` finds one, and offers if the plant loads.

    `apart`: the plant's Python is first tried in another process, as nobody knows yet whether it ends.
    """
    found = checked(file, apart=apart)
    mend = mending(file, found.findings) if mending and found.findings else None
    stated = () if found.model is None else offers(file.name, file.read_text("utf-8"), found.model)
    return Answer(findings=found.findings, mend=mend, offers=stated)
