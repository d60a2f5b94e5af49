"""Survivors that are no bugs: each with the reason why nobody can notice it."""

from __future__ import annotations

from pathlib import Path

import yaml

from .mutant import Mutant

FILE = Path(__file__).with_name("equivalent.yaml")


def reasons(path: Path = FILE) -> dict[str, str]:
    """The reason by the key of the mutant."""
    rows = yaml.safe_load(path.read_text()) or []
    return {row["mutant"]: " ".join(row["reason"].split()) for row in rows}


def gone(argued: dict[str, str], mutants: list[Mutant]) -> list[str]:
    """Reasons for a mutant that there is no more."""
    keys = {mutant.key for mutant in mutants}
    return [key for key in argued if key not in keys]
