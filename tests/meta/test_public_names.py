"""What users import is named in one place, has docstrings, and stands on the page made of these."""

from __future__ import annotations

import importlib
import inspect
from importlib.util import find_spec
from pathlib import Path

import pytest

from arboleda import extension

from ..scripts import printed

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/reference/api.md"
MODULES = [
    name
    for name in (
        "arboleda.client",
        "arboleda.extension",
        "arboleda.recipes",
        "arboleda.kinds",
        "arboleda.drivers",
        "arboleda.engine",
        "arboleda.testing",
        "arboleda.testing.drivers",
        "arboleda_fleet.client",
        "arboleda_make.client",
        "arboleda_proofs.client",
        "arboleda_proofs.testing",
    )
    if find_spec(name) and hasattr(importlib.import_module(name), "__all__")
]


def test_the_door_for_packages_stays_small() -> None:
    assert len(extension.__all__) <= 60


def test_the_page_is_what_the_script_prints() -> None:
    assert PAGE.read_text(encoding="utf-8") == printed("api-reference"), "run `make reference`"


@pytest.mark.parametrize("module", MODULES)
def test_every_public_name_exists_and_says_what_it_is_for(module: str) -> None:
    public = importlib.import_module(module)
    assert inspect.getdoc(public)
    for name in public.__all__:
        thing = getattr(public, name)
        documented = inspect.getdoc(thing) and "Alias for" not in (inspect.getdoc(thing) or "")
        assert documented or not (inspect.isclass(thing) or inspect.isfunction(thing)), name


@pytest.mark.parametrize("module", MODULES)
def test_a_module_names_each_once_and_stands_on_the_page(module: str) -> None:
    names = list(importlib.import_module(module).__all__)
    assert len(set(names)) == len(names) and f"## `{module}`" in PAGE.read_text(encoding="utf-8")
