"""Packages that bring routes of their own: which paths are whose, for a plant that runs without them."""

from __future__ import annotations

import re
from collections.abc import Collection

from arboleda.model.packages import FLEET, MAKE, MISSING, PROOFS, THIS, PackageMissing

PATHS = {
    FLEET: re.compile(r"/api/oee"),
    MAKE: re.compile(r"/api/(draft|make|proposals|teach|trees|versions)(/.*)?|/api/assistants/tasks"),
    PROOFS: re.compile(r"/api/faults(/.*)?|/api/tasks/[^/]+/report"),
}


def missing(package: str) -> PackageMissing:
    """The refusal of what a package brings that is not installed here."""
    return PackageMissing(MISSING(what=THIS(), package=package))


def refuse_path(path: str, installed: Collection[str]) -> None:
    """Raise PackageMissing for a path of a package that is not among the installed ones."""
    for package, paths in PATHS.items():
        if package not in installed and paths.fullmatch(path):
            raise missing(package)
