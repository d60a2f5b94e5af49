"""A memory is kept by what is registered for the scheme of its address; who is missing is named."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.added_package import install
from tests.packages import leave_out

from arboleda.model.errors import StartError
from arboleda.runtime import stores
from arboleda.store import schemes
from arboleda.store.sqlite import Store

SHELF = """
from pathlib import Path

from arboleda.store.sqlite import Store


class Shelf:
    def memory(self, address, plant):
        return Store(Path(address.partition("://")[2]), plant)
"""
Install = Callable[[str], None]


@pytest.fixture
def put(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Installs a package that keeps memories at `shelf://`."""
    monkeypatch.syspath_prepend(tmp_path / "site")
    yield lambda code: install(tmp_path / "site", "shelf", code, group=schemes.GROUP, what="Shelf")
    sys.modules.pop("shelf", None)


def test_a_package_keeps_memories_at_addresses_of_its_scheme(tmp_path: Path, put: Install) -> None:
    put(SHELF)
    assert schemes.objection("shelf://here") == "" and "shelf" not in sys.modules, "it is not loaded yet"
    memory = stores.memory_of(f"shelf://{tmp_path / 'plant.sqlite'}", tmp_path, "lab")
    assert isinstance(memory, Store)


def test_a_package_that_cannot_be_loaded_is_named(tmp_path: Path, put: Install) -> None:
    put("import no_such_library")
    with pytest.raises(StartError, match="keeps a memory at shelf:// cannot be loaded: No module named"):
        stores.memory_of("shelf://here", tmp_path, "lab")


def test_what_is_no_address_is_refused() -> None:
    with pytest.raises(StartError, match=r"^The address of a store must be postgresql://USER@HOST:PORT/DAT"):
        schemes.databases("plants.sqlite")


def test_an_address_of_no_installed_scheme_is_refused_with_those_that_there_are(put: Install) -> None:
    put(SHELF)
    with pytest.raises(StartError) as refused:
        schemes.databases("attic://me:secret@here")
    said, _, names = str(refused.value).partition("; there are ")
    assert said == "nothing that is installed here keeps a memory at attic://"
    assert "shelf" in names.removesuffix(".").split(", ") and "secret" not in names


def test_a_scheme_whose_package_is_missing_is_named_with_the_line_that_installs_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    leave_out(monkeypatch, tmp_path, "arboleda_fleet")
    with pytest.raises(StartError, match=r"postgresql:// needs .*: type pip install 'arboleda\[fleet\]'\."):
        schemes.databases("postgresql://db.example/plants")
