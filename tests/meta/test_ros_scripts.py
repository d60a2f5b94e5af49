"""What `make ros-test` stands on: the prefix that it builds with, and its judgement of colcon's results."""

from __future__ import annotations

import sysconfig
from pathlib import Path

import pytest

from ..scripts import load

ROOT = Path(__file__).parents[2]
LINE = "build/{}/pytest.xml: {} tests, 0 errors, 0 failures, {} skipped\n"


@pytest.fixture
def wheels(tmp_path: Path) -> Path:
    """An environment with one CMake file, to be filled."""
    for folder in ("lib", "include", "share/x/cmake"):
        (tmp_path / "wheels" / folder).mkdir(parents=True)
    return tmp_path / "wheels"


def mended(wheels: Path, text: str) -> str:
    """The CMake file of the prefix that is made of `wheels` when theirs says `text`."""
    (wheels / "share/x/cmake/x.cmake").write_text(text)
    prefix = wheels.parent / "prefix"
    load("ros-prefix").make(prefix, wheels)
    return (prefix / "share/x/cmake/x.cmake").read_text()


@pytest.mark.requires("numpy")
def test_the_prefix_names_the_include_folders_of_this_python(wheels: Path) -> None:
    import numpy

    python = "/opt/python/cp312-cp312/include/python3.12"
    numpys = "/opt/python/cp312-cp312/lib/python3.12/site-packages/numpy/_core/include"
    folders = f"{sysconfig.get_path('include')};{numpy.get_include()}"
    assert mended(wheels, f'set(A "{python};{numpys}")') == f'set(A "{folders}")'


@pytest.mark.requires("numpy")
def test_a_folder_of_the_building_machine_that_nothing_replaces_is_named(wheels: Path) -> None:
    with pytest.raises(SystemExit, match=r"x\.cmake names a folder under /opt/python/"):
        mended(wheels, 'set(A "/opt/python/cp312-cp312/lib/libpython.a")')


def python_packages() -> list[str]:
    script = load("ros-test")
    python = [name for name, kind in script.PACKAGES.items() if kind == "ros.ament_python"]
    return [name for name in python if name not in script.TESTED_ELSEWHERE]


def test_a_package_without_tests_is_named() -> None:
    first, second, *others = python_packages()
    results = "".join(LINE.format(name, 1, 0) for name in others) + LINE.format(first, 0, 0)
    wrong = load("ros-test").shortcomings(results)
    assert wrong == [f"{name} has no test that colcon ran" for name in (first, second)]


def test_a_skip_counts_where_none_is_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    results = "".join(LINE.format(name, 2, 1) for name in python_packages())
    monkeypatch.delenv("ARBOLEDA_REQUIRE", raising=False)
    assert load("ros-test").shortcomings(results) == []
    monkeypatch.setenv("ARBOLEDA_REQUIRE", "all")
    assert load("ros-test").shortcomings(results) == [f"{name} skips tests" for name in python_packages()]


def test_every_package_in_the_tree_is_demanded() -> None:
    described = (*ROOT.glob("src/*/package.xml"), *ROOT.glob("packages/*/package.xml"))
    packages = {path.parent.name for path in described}
    assert load("ros-test").PACKAGES.keys() == packages


def test_an_environment_that_is_activated_is_none_of_the_build(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VIRTUAL_ENV", "/elsewhere")
    assert "VIRTUAL_ENV" not in load("ros-test").environment()
