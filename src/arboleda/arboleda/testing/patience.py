"""Patience of tests of real parts: they wait as long as the busiest machine takes."""

from __future__ import annotations

import os

PATIENCE_S = float(os.environ.get("ARBOLEDA_PATIENCE_S", "90"))
