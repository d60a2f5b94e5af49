"""A tree with one file of the core, in which mutants are planted."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda_mutation.sources import PACKAGE, Sources

CORE = """
LIMIT = 3


def fits(number):
    return number < LIMIT
"""


@pytest.fixture
def sources(tmp_path: Path) -> Sources:
    """A tree with one file of the core."""
    file = tmp_path / PACKAGE / "core" / "sizes.py"
    file.parent.mkdir(parents=True)
    for folder in (file.parent, file.parents[1]):
        (folder / "__init__.py").touch()
    file.write_text(CORE)
    return Sources(tmp_path)
