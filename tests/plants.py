"""Plants that tests read: plant files in `plants.yaml` and rows of data in `rows.yaml`, beside the tests."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

import yaml


def plant_text(test: str, name: str) -> str:
    """The plant file of that name: what stands in `plants.yaml` after a line `--- # name`."""
    return _documents(Path(test).with_name("plants.yaml"))[name]


def rows(test: str, name: str) -> dict[str, Any]:
    """The rows of that name in `rows.yaml`, each by what it is about."""
    found: dict[str, Any] = _sections(Path(test).with_name("rows.yaml"))[name]
    return found


@cache
def _documents(file: Path) -> dict[str, str]:
    _, *parts = re.split(r"^--- # (\w+)\n", file.read_text("utf-8"), flags=re.MULTILINE)
    return dict(zip(parts[::2], parts[1::2], strict=True))


@cache
def _sections(file: Path) -> dict[str, dict[str, Any]]:
    found: dict[str, dict[str, Any]] = yaml.safe_load(file.read_text("utf-8"))
    return found
