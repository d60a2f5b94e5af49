"""Revision of the code that is measured, by git."""

from __future__ import annotations

import subprocess
from pathlib import Path

HERE = Path(__file__).parents[1]


def revision() -> str:
    """The commit, with `+` where product or benchmarks have changed since; "" outside of a repository."""
    commit = _git("rev-parse", "--short=12", "HEAD")
    changed = bool(commit) and _git("status", "--porcelain", "--", "../../src", ".")
    return f"{commit}+" if changed else commit


def _git(*words: str) -> str:
    try:
        found = subprocess.run(["git", *words], cwd=HERE, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return found.stdout.strip()
