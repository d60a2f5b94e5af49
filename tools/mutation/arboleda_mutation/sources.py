"""The files that get mutants, and the sample that a seed draws of all of these."""

from __future__ import annotations

import ast
from collections.abc import Iterable
from functools import cached_property
from hashlib import sha256
from pathlib import Path

from . import trees
from .mutant import Mutant

PACKAGE = Path("src/arboleda/arboleda")
PROOFS = Path("packages/arboleda_proofs/src/arboleda_proofs")
ENGINE = ("model", "dispatch", "trees", "resume", "core")
MUTATED = (*ENGINE, "departures", "recipes", "views", "wire")


class Sources:
    """The source tree at `root`; it is only read."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self._package = root / PACKAGE
        paths = sorted(path for name in MUTATED for path in (self._package / name).glob("*.py"))
        self._texts = {path.relative_to(self._package).as_posix(): path.read_text() for path in paths}
        self._enums = trees.enumerations(list(self._texts.values()))

    @cached_property
    def mutants(self) -> list[Mutant]:
        """All of them."""
        return [each for file, text in self._texts.items() for each in trees.mutants(file, text, self._enums)]

    def sample(self, size: int, seed: int) -> list[Mutant]:
        """As many as wanted, the same for the same seed: whoever else comes or goes, most of them stay."""

        def rank(mutant: Mutant) -> str:
            return sha256(f"{seed}/{mutant.key}".encode()).hexdigest()

        return sorted(self.mutants, key=rank)[:size]

    def mutated(self, mutant: Mutant) -> ast.Module:
        return trees.mutated(self._texts[mutant.file], self._enums, mutant.number)

    def path(self, file: str) -> Path:
        return self._package / file

    def module(self, file: str) -> str:
        """The name under which a file is imported."""
        return ".".join(("arboleda", *Path(file).with_suffix("").parts)).removesuffix(".__init__")

    def files(self) -> Iterable[str]:
        return self._texts


def fingerprint(root: Path, folders: Iterable[str]) -> str:
    """Changes whenever something in one of the folders does; FileNotFoundError where one is missing."""
    found = sha256()
    for folder in folders:
        (root / folder).stat()
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".py", ".yaml", ".json") and "__pycache__" not in path.parts:
                found.update(path.relative_to(root).as_posix().encode() + b"\0" + path.read_bytes())
    return found.hexdigest()[:16]
