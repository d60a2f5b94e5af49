"""Answers with what is wrong with a plant, and what would mend it, as data."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..proof.calm import Calm
from .finding import Finding, checked, run_findings
from .mend import Mend
from .offers import Offer, offers
from .search import Search


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


def check_answer(file: Path, *, within_s: float = math.inf, apart: bool = True) -> Answer:
    """The findings of `arboleda check`, with a mend that is looked for so long; none for 0 s.

    `apart`: the plant's Python is first tried in another process, as nobody knows yet whether it ends.
    """
    found = checked(file, apart=apart)
    answer = _answer(file, found.findings, within_s)
    if found.model is None:
        return answer
    return replace(answer, offers=offers(file.name, file.read_text("utf-8"), found.model))


def run_answer(file: Path, runs: Iterable[Calm], *, within_s: float = math.inf) -> Answer:
    """The findings of runs of this plant without faults, with a mend."""
    return _answer(file, tuple(each for calm in runs for each in run_findings(calm)), within_s)


def _answer(file: Path, findings: tuple[Finding, ...], within_s: float) -> Answer:
    mend = Search(file=file, found=findings, within_s=within_s).mend() if findings and within_s else None
    return Answer(findings=findings, mend=mend)
