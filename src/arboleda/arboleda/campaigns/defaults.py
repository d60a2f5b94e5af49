"""What `arboleda simulate` does where it is not told otherwise."""

from __future__ import annotations

SEED, SEEDS, CYCLES, LEVEL = 1, 20, 50, "normal"
