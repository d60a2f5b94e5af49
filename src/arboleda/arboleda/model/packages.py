"""Packages beside the runner: their names, and the sentence on one that is not installed."""

from __future__ import annotations

from .errors import ArboledaError
from .sentence import Phrase

BOARDS, CLASS, DRIVERS = "boards", "class", "drivers"
FLEET, MAKE, PROOFS, TREES = "fleet", "make", "proofs", "trees"
THIS = Phrase("package.this", "This")
MISSING = Phrase(
    "package.missing",
    "{what} needs the package {package}, which is not installed here: type pip install 'arboleda[{package}]'",
)


class PackageMissing(ArboledaError):
    """Something is asked for that a package brings, which is not installed."""
