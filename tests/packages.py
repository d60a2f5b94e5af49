"""Packages beside the cell runner: their names, and the folders of their code."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = {each.parent.name: each.parent for each in sorted(ROOT.glob("packages/*/src/*/__init__.py"))}
