"""Packages that are imported without what they would take with them."""

from __future__ import annotations

import importlib
import sys

import pytest

from arboleda.dashboard.toolkit import without


def test_a_module_is_missing_meanwhile_and_there_afterwards(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "colorsys", raising=False)
    with without("colorsys"), pytest.raises(ImportError):
        importlib.import_module("colorsys")
    assert importlib.import_module("colorsys").rgb_to_hsv


def test_a_module_that_is_there_already_stays() -> None:
    with without("json"):
        assert importlib.import_module("json").loads("1") == 1
