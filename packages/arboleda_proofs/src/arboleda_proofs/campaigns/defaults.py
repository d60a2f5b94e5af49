"""Defaults of `arboleda simulate`."""

from __future__ import annotations

SEED, SEEDS, CYCLES, LEVEL = 1, 20, 50, "normal"
