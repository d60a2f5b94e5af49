"""Mends for what a check and runs without faults have found."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

from arboleda.plant_file.answer import Answer
from arboleda.plant_file.findings import Finding
from arboleda.plant_file.mend import Mend

from ..proof.calm import Calm
from .search import Search, run_findings


def mend_of(file: Path, findings: tuple[Finding, ...], *, within_s: float = math.inf) -> Mend | None:
    """A mend for findings of a plant, looked for so long; None where nothing that was tried is better."""
    return Search(file=file, found=findings, within_s=within_s).mend()


def run_answer(file: Path, runs: Iterable[Calm], *, within_s: float = math.inf) -> Answer:
    """The findings of runs of this plant without faults, with a mend; none is looked for in 0 s."""
    findings = tuple(each for calm in runs for each in run_findings(calm))
    mend = mend_of(file, findings, within_s=within_s) if findings and within_s else None
    return Answer(findings=findings, mend=mend)
