"""Packages that are imported without what they would take with them."""

from __future__ import annotations

import importlib
import subprocess
import sys

import pytest

from arboleda.host.imports import without

PAGE = "import sys, arboleda.dashboard.page; print(*sys.modules)"


def test_a_module_is_missing_meanwhile_and_there_afterwards(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "colorsys", raising=False)
    with without("colorsys"), pytest.raises(ImportError):
        importlib.import_module("colorsys")
    assert importlib.import_module("colorsys").rgb_to_hsv


def test_a_module_that_is_there_already_stays() -> None:
    with without("json"):
        assert importlib.import_module("json").loads("1") == 1


def test_a_page_loads_no_clients_of_its_toolkit() -> None:
    loaded = subprocess.run([sys.executable, "-c", PAGE], capture_output=True, text=True, check=True).stdout
    assert {"nicegui", "engineio"} <= set(loaded.split())
    assert {"aiohttp", "requests", "tornado"}.isdisjoint(loaded.split())
