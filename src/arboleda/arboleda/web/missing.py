"""Packages that bring routes of their own: which paths are whose, for a plant that runs without them."""

from __future__ import annotations

import re
from collections.abc import Collection

from arboleda.model.packages import FLEET, MAKE, MISSING, PROOFS, THIS, PackageMissing

PATHS = {
    FLEET: re.compile(r"/api/oee|/oee\.json"),
    MAKE: re.compile(
        r"/api/(draft|make|proposals|teach|trees|versions)(/.*)?|/api/assistants/tasks"
        r"|/(findings|versions)\.json|/proof"
    ),
    PROOFS: re.compile(r"/api/faults(/.*)?|/api/tasks/[^/]+/report|/past/scene\.json|/report"),
}


def missing(package: str) -> PackageMissing:
    """The refusal of what a package brings that is not installed here."""
    return PackageMissing(MISSING(what=THIS(), package=package))


def package_missing(path: str, installed: Collection[str]) -> str | None:
    """The package of a path, if it is not among the installed ones."""
    lacking = (package for package in PATHS if package not in installed)
    return next((package for package in lacking if PATHS[package].fullmatch(path)), None)
