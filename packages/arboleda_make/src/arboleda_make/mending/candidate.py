"""Candidate: a change that may mend something; nobody is told of it before it was tried."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.plant_check.mend import Cut


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """Candidate: cuts in files, the sentence that says what they do, and how likely they are to mend."""

    cuts: tuple[Cut, ...]
    sentence: str
    score: float
