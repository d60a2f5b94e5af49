"""The playground has the libraries that were tried together, the one that is WebAssembly too."""

from __future__ import annotations

from pathlib import Path

from tests.scripts import load

ROOT = Path(__file__).parents[4]


def test_the_core_of_pydantic_is_the_one_of_the_constraints() -> None:
    name, version = load("playground").CORE.split("-")[:2]
    assert f"{name.replace('_', '-')}=={version}\n" in (ROOT / "constraints.txt").read_text("utf-8")
