"""Workers of one run of pytest, and what they share."""

from __future__ import annotations

import os
from pathlib import Path

import pytest


def shared_between_workers(factory: pytest.TempPathFactory) -> Path:
    """A folder of this run; pytest-xdist gives each worker a folder of its own below it."""
    own = factory.getbasetemp()
    return own.parent if "PYTEST_XDIST_WORKER" in os.environ else own
