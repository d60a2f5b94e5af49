"""Entry points of installed packages are read again where a package was installed, and not otherwise."""

from __future__ import annotations

import os
import sys
from importlib import metadata
from pathlib import Path
from unittest import mock

import pytest

from arboleda.host import packages

GROUP = "arboleda.test_of_packages"


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for installed packages, the only one: other tests write into folders of the checkout."""
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    return tmp_path


def install(site: Path, name: str) -> None:
    about = site / f"{name}-1.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1\n", "utf-8")
    (about / "entry_points.txt").write_text(f"[{GROUP}]\n{name} = {name}:Kind\n", "utf-8")
    later = site.stat().st_mtime_ns + 10**9  # however coarse the clock of the disk is
    os.utime(site, ns=(later, later))


def names() -> list[str]:
    return sorted(each.name for each in packages.entry_points(GROUP))


def test_a_package_that_was_installed_since_is_there(site: Path) -> None:
    assert names() == []
    install(site, "acme")
    assert names() == ["acme"]
    install(site, "bolt")
    assert names() == ["acme", "bolt"]


def test_packages_are_read_once_while_nothing_is_installed(site: Path) -> None:
    install(site, "acme")
    before = names()
    with mock.patch.object(metadata, "entry_points", side_effect=AssertionError):
        assert names() == before == ["acme"]


def test_a_folder_that_is_gone_is_none_of_them(site: Path) -> None:
    sys.path.insert(0, str(site / "gone"))  # of the list of the test alone
    install(site, "acme")
    assert names() == ["acme"]
