"""Answer of `arboleda check` as data: what is wrong with a plant, and a change that would mend it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .findings import PlantFinding, checked
from .mend import Mend
from .offers import Offer, offers

Mending = Callable[[Path, tuple[PlantFinding, ...]], Mend | None]  # a plant file and its findings -> a mend


@dataclass(frozen=True, kw_only=True)
class CheckAnswer:
    """Findings of a plant, and a mend for them; None where no change that was tried makes the plant better.

    `offers` are rules that the plant file could state, and does not.
    """

    findings: tuple[PlantFinding, ...]
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


def check_answer(file: Path, *, mending: Mending | None = None, apart: bool = True) -> CheckAnswer:
    """The findings of `arboleda check`, with a mend if `mending` finds one, and offers if the plant loads.

    `apart`: the plant's Python is first tried in another process, for it may never end.
    """
    result = checked(file, apart=apart)
    mend = mending(file, result.findings) if mending and result.findings else None
    stated = () if result.model is None else offers(file.name, file.read_text("utf-8"), result.model)
    return CheckAnswer(findings=result.findings, mend=mend, offers=stated)
