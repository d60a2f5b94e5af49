"""Packages that are imported without what they would take with them."""

from __future__ import annotations

import subprocess
import sys

PAGE = "import sys, arboleda.dashboard.page; print(*sys.modules)"


def test_a_page_loads_no_clients_of_its_toolkit() -> None:
    loaded = subprocess.run([sys.executable, "-c", PAGE], capture_output=True, text=True, check=True).stdout
    assert {"nicegui", "engineio"} <= set(loaded.split())
    assert {"aiohttp", "requests", "tornado"}.isdisjoint(loaded.split())
