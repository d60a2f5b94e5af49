"""Packages that may be missing: the runner knows whose each command and each path of the API is."""

from __future__ import annotations

from tests.unit.web.test_package_routes import paths

from arboleda.cli.commands import OF_PACKAGES, commands
from arboleda.host.packages import package_of, registered
from arboleda.web import missing, routes


def test_every_package_that_is_missed_is_one_of_this_repository() -> None:
    installed = {name: each.module.split(".")[0] for name, each in commands().items() if "." in each.module}
    assert installed == {name: f"arboleda_{package}" for name, package in OF_PACKAGES.items()}


def test_every_path_of_a_package_is_known_as_its_own() -> None:
    brought: dict[str, list[str]] = {}
    for point in registered(routes.GROUP):
        brought.setdefault(package_of(point), []).extend(paths(point.load()(None)))
    assert brought.keys() == missing.PATHS.keys()
    for package, mine in brought.items():
        assert mine and all(missing.PATHS[package].fullmatch(path) for path in mine), mine
